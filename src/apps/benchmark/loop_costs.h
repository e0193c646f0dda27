// What the index and the graph take as they grow, with made-up keyframes.
#pragma once

#include <ctime>
#include <string>

#include "depth_fusion/loops/loop_parameters.h"

namespace depth_fusion {

// Of the processor, so that what else runs does not count.
template <class Action>
double millisecondsOf(const Action& action) {
  const std::clock_t begin = std::clock();
  action();
  return 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

// Tables.
std::string measureLoopCosts(const LoopParameters& parameters);

}  // namespace depth_fusion
