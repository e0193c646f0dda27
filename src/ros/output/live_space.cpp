#include "ros/output/live_space.h"

#include <utility>

#include "depth_fusion/submaps/world_mesh.h"

namespace depth_fusion {
namespace {

constexpr size_t kMaxFrames = 4;  // that wait, in memory of the device

}  // namespace

LiveSpace::LiveSpace(const std::shared_ptr<SharedMap>& map, const EsdfParameters& parameters)
    : map_(map), queue_(map->compute->anotherQueue()), inbox_(std::make_shared<Inbox>()) {
  inbox_->stride = parameters.frame_stride;
  const auto take = [inbox = inbox_](const std::shared_ptr<const DepthFrame>& depth, const Pose& T_W_D,
                                     uint32_t generation) {
    const std::lock_guard<std::mutex> lock(inbox->mutex);
    if (inbox->fused++ % inbox->stride != 0) return;
    inbox->frames.push_back({depth, T_W_D, generation});
    if (inbox->frames.size() > kMaxFrames) inbox->frames.pop_front();
  };
  listener_ = std::make_shared<const FrameListener>(take);
  map->locked([&](FusedMap& fused) {
    esdf_ = std::make_unique<Esdf>(*queue_, fused.map(), parameters);
    esdf_->lookElsewhere(std::make_unique<WorldParts>(*queue_, fused.submaps()));
    fused.listen(listener_);
  });
}

bool LiveSpace::update(StageTimers& timers) {
  const std::shared_ptr<SharedMap> map = map_.lock();
  if (map == nullptr) return false;
  uint32_t generation = 0;
  const bool is_new = map->locked([&](FusedMap& fused) {
    map->compute->finish();
    generation = fused.map().generation();
    return esdf_->readMap(timers);
  });
  std::deque<Frame> frames;
  {
    const std::lock_guard<std::mutex> lock(inbox_->mutex);
    frames.swap(inbox_->frames);
  }
  if (is_new) seeKeyframes(*map, generation);
  for (const Frame& frame : frames) {
    if (frame.generation == generation) esdf_->see(*frame.depth, frame.T_W_D, timers);
  }
  return !esdf_->update(timers).empty() || is_new;
}

void LiveSpace::seeKeyframes(SharedMap& map, uint32_t generation) {
  const auto see = [this](const Keyframe& keyframe, const Pose& T_W_D) {
    if (!keyframe.view.isEmpty()) esdf_->see(keyframe.view.depth(), keyframe.view.camera(), T_W_D);
  };
  for (const KeyframePtr& keyframe : map.keyframesOf(generation)) see(*keyframe, keyframe->T_W_D);
  const LoopsOfMap loops = map.loopsOf(generation);
  if (loops.closing == nullptr) return;
  const Corrections known = loops.closing->keyframes();
  for (size_t i = 0; i < known.keyframes().size(); ++i)
    see(*loops.closing->keyframe(static_cast<uint32_t>(i)), known.keyframes()[i].T_W_now);
}

}  // namespace depth_fusion
