// What is known of the space of a live map.
#pragma once

#include <deque>
#include <memory>
#include <mutex>
#include <string>

#include "depth_fusion/esdf/esdf.h"
#include "ros/in_process/shared_map.h"

namespace depth_fusion {

// Follows one map, by a queue of its own. For one thread; the map may change meanwhile.
class LiveSpace {
 public:
  LiveSpace(const std::shared_ptr<SharedMap>& map, const EsdfParameters& parameters);

  bool follows(const std::shared_ptr<SharedMap>& map) const { return map_.lock() == map; }
  // Takes in what has changed; returns whether something has. Free space of a map that it has not followed
  // from the beginning comes from what keyframes saw. The map is locked while its surface is read.
  bool update(StageTimers& timers);
  const EsdfGrid& grid() const { return esdf_->grid(); }
  // Why something is left out; empty if all is well.
  const std::string& problem() const { return esdf_->problem(); }

 private:
  struct Frame {
    std::shared_ptr<const DepthFrame> depth;
    Pose T_W_D;
    uint32_t generation;
  };
  struct Inbox {
    std::mutex mutex;
    std::deque<Frame> frames;  // the oldest first
    int stride, fused = 0;
  };

  void seeKeyframes(SharedMap& map, uint32_t generation);

  std::weak_ptr<SharedMap> map_;
  std::unique_ptr<ComputeContext> queue_;
  std::unique_ptr<Esdf> esdf_;
  std::shared_ptr<Inbox> inbox_;
  std::shared_ptr<const FrameListener> listener_;
};

}  // namespace depth_fusion
