// Keyframes with true poses, for loops.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "apps/benchmark/loops.h"
#include "depth_fusion/relocalisation/keyframe.h"

namespace depth_fusion {

struct LoopInput {
  std::string name;
  std::vector<KeyframePtr> keyframes;      // T_W_D: the truth
  double wrong_m = 0.1, wrong_rad = 0.05;  // a loop that is farther from the truth is false
};

// Calls `visit` with each of the inputs that options.inputs names, or all. Throws Error for a name that is
// not known; recordings that are not there are left out, and said so.
void forEachLoopInput(const LoopsOptions& options, const std::function<void(const LoopInput&)>& visit);

}  // namespace depth_fusion
