#include "depth_fusion/pipeline/frame_ahead.h"

#include <utility>

#include "depth_fusion/common/error.h"

namespace depth_fusion {

TexturedFrame FrameAhead::textureOf(const RgbdFrame& frame, StageTimers& timers) {
  if (!announced_) {
    TexturedFrame texture = odometry_.texture(frame, timers);
    texture.robot = knowledgeOf(frame);
    known_.reset();
    return texture;
  }
  check(frame.stamp_s == announced_->stamp_s, "the frame at " + std::to_string(announced_->stamp_s) +
                                                  " s was announced, but that at " +
                                                  std::to_string(frame.stamp_s) + " s came");
  wait();
  const RobotKnowledge known = knowledgeOf(*announced_);
  announced_.reset();
  known_.reset();
  timers.append(std::exchange(timers_, {}));
  TexturedFrame texture = texture_.get();
  texture.robot = known;
  return texture;
}

const RobotKnowledge& FrameAhead::knowledgeOf(const RgbdFrame& frame) {
  if (!known_) {
    robot_.add(frame.readings);
    known_ = robot_.knowledge(frame.stamp_s);
  }
  return *known_;
}

void FrameAhead::announce(const RgbdFrame* next) {
  if (next == nullptr) return;
  announced_ = *next;
  texture_ = std::async(std::launch::async, [this] { return odometry_.texture(*announced_, timers_); });
}

void FrameAhead::prepare() {
  if (!announced_) return;
  const RobotKnowledge& known = knowledgeOf(*announced_);  // here, in the order of the frames
  texture_ = std::async(std::launch::async, [this, &known, found = std::move(texture_)]() mutable {
    TexturedFrame texture = found.get();
    texture.robot = known;
    session_.prepareAhead(*announced_, texture, timers_);
    return texture;
  });
}

void FrameAhead::wait() const {
  if (texture_.valid()) texture_.wait();
}

void FrameAhead::checkNoneAnnounced() const { check(!announced_, "a frame was announced, and has not come"); }

}  // namespace depth_fusion
