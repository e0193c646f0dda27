// Decides which frames come into a live map.
#pragma once

#include <cstdint>
#include <string>

#include "ros/in_process/frames.h"

namespace depth_fusion {

// What is to become of a frame.
struct Admission {
  bool fuse = false;
  Beginning begins = Beginning::kNone;
  bool may_predict_from = false;  // the tracker may go on from it though it is not fused
  std::string reason;             // why it is not fused
};

// What the decision needs to know of the map.
struct MapState {
  uint32_t generation = 0;
  bool is_empty = true;
};

// Frames are refused that were taken before the map was emptied, before the clock jumped back, or while
// mapping stands still. Whoever calls it holds what guards the map.
class FrameAdmission {
 public:
  // `external`: the frames' poses come from elsewhere than icp_tracking. The map has not been reset yet.
  FrameAdmission(bool external, uint32_t first_generation)
      : external_(external), first_generation_(first_generation) {}

  bool isExternal() const { return external_; }

  // `resets_on_jump`: a clock that jumps back empties the map, if the poses come from elsewhere. Otherwise
  // the tracker decides which frame begins the map.
  Admission admit(const TrackedFrame& frame, const MapState& map, bool resets_on_jump);

  void noteReset(const MapReset& reset) { reset_ = reset; }
  void setMode(MapMode mode) { mode_ = mode; }
  const MapReset& lastReset() const { return reset_; }
  MapMode mode() const { return mode_; }

 private:
  bool isFromBeforeReset(const TrackedFrame& frame, const MapState& map) const;

  bool external_;
  uint32_t first_generation_;  // of the map before any reset
  MapReset reset_;             // the last one that was called for
  MapMode mode_ = MapMode::kMapping;
  uint32_t clock_jumps_ = 0;  // of the last frame
};

}  // namespace depth_fusion
