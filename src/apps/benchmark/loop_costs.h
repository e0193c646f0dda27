// What the index and the graph take as they grow, with made-up keyframes.
#pragma once

#include <chrono>
#include <string>

#include "depth_fusion/loops/loop_parameters.h"

namespace depth_fusion {

template <class Action>
double millisecondsOf(const Action& action) {
  const auto begin = std::chrono::steady_clock::now();
  action();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

// Tables.
std::string measureLoopCosts(const LoopParameters& parameters);

}  // namespace depth_fusion
