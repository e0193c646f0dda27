#include "ros/in_process/frame_admission.h"

#include <utility>

namespace depth_fusion {
namespace {

Admission refused(const std::string& reason) { return {false, Beginning::kNone, false, reason}; }

}  // namespace

Admission FrameAdmission::admit(const TrackedFrame& frame, const MapState& map, bool resets_on_jump) {
  const uint32_t clock_jumps = frame.sensor->clock_jumps;
  if (isFromBeforeReset(frame, map)) return refused(kBeforeReset);
  if (clock_jumps < clock_jumps_) return refused("from before a clock jump");
  const bool clock_jumped = clock_jumps > std::exchange(clock_jumps_, clock_jumps);
  if (mode_ == MapMode::kPaused) return refused("paused");
  if (mode_ == MapMode::kLocalisation)
    return {false, Beginning::kNone, !map.is_empty && frame.begins == Beginning::kNone, "localisation only"};
  const Beginning by_clock = clock_jumped && resets_on_jump ? Beginning::kMap : Beginning::kNone;
  return {true, external_ ? by_clock : frame.begins, true, ""};
}

bool FrameAdmission::isFromBeforeReset(const TrackedFrame& frame, const MapState& map) const {
  if (reset_.isAfter(*frame.sensor)) return true;
  if (external_ || frame.map_generation == map.generation) return false;
  // A tracker that has not heard of a map yet may begin the very first one.
  return frame.map_generation != 0 || map.generation != first_generation_ || !map.is_empty;
}

}  // namespace depth_fusion
