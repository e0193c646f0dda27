// What the loops of a run make of its poses.
#pragma once

#include <string>

#include "depth_fusion/pipeline/loop_closing.h"

namespace depth_fusion {

struct LoopResults {
  std::string table;  // a line for each pair of keyframes that was compared, as CSV
  size_t closed = 0;
  Trajectory corrected;
  double moved_m = 0.0;   // the pose that is moved most
  Corrections keyframes;  // with the parts that they are of
  bool joins_parts = false;
};

// Waits until all keyframes are compared.
LoopResults resultsOf(LoopClosing& loops, const Trajectory& tracked);

// The keyframes where the trajectory has them. Those that it does not have are left out.
Keyframes movedTo(const Trajectory& trajectory, const Keyframes& keyframes);

}  // namespace depth_fusion
