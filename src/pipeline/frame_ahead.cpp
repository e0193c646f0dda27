#include "depth_fusion/pipeline/frame_ahead.h"

#include <utility>

#include "depth_fusion/common/error.h"

namespace depth_fusion {

TexturedFrame FrameAhead::textureOf(const RgbdFrame& frame, StageTimers& timers) {
  if (!announced_) return odometry_.texture(frame, timers);
  check(frame.stamp_s == announced_->stamp_s, "the frame at " + std::to_string(announced_->stamp_s) +
                                                  " s was announced, but that at " +
                                                  std::to_string(frame.stamp_s) + " s came");
  wait();
  announced_.reset();
  timers.append(std::exchange(timers_, {}));
  return texture_.get();
}

void FrameAhead::announce(const RgbdFrame* next) {
  if (next == nullptr) return;
  announced_ = *next;
  texture_ = std::async(std::launch::async, [this] { return odometry_.texture(*announced_, timers_); });
}

void FrameAhead::prepare() {
  if (!announced_) return;
  texture_ = std::async(std::launch::async, [this, found = std::move(texture_)]() mutable {
    TexturedFrame texture = found.get();
    session_.prepareAhead(*announced_, texture, timers_);
    return texture;
  });
}

void FrameAhead::wait() const {
  if (texture_.valid()) texture_.wait();
}

void FrameAhead::checkNoneAnnounced() const { check(!announced_, "a frame was announced, and has not come"); }

}  // namespace depth_fusion
