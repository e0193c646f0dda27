// The paper's comparison of the filters, through the real kernels.
#include <gtest/gtest.h>

#include <cstdio>

#include "depth_fusion/evaluation/wall_experiment.h"

namespace depth_fusion {
namespace {

constexpr double kGain = 0.05;

// From a Kinect's noise at 0.4 m to that at 2 m.
WallExperiment growingNoise() {
  WallExperiment experiment;
  experiment.first_sigma_m = 0.0012;
  experiment.frame_at = [](int frame) { return WallFrame{1.0, 0.0012 + 0.0049 * frame / 200.0}; };
  return experiment;
}

double finalError(ComputeContext& compute, const std::string& rule, WallExperiment experiment) {
  experiment.told_of_noise = rule == "kalman";
  const auto errors =
      runWallExperiment(compute, experiment, filterOfGain(rule, kGain, experiment.first_sigma_m));
  const double final_m = rootMeanSquare(errors, errors.size() - 10);
  std::printf("%s: %.3f mm\n", rule.c_str(), 1000.0 * final_m);
  return final_m;
}

TEST(FilterExperiments, growing_noise_hurts_the_kalman_filter_half_as_much) {
  ComputeContext compute;
  const double weighted = finalError(compute, "weighted", growingNoise());
  EXPECT_LE(finalError(compute, "kalman", growingNoise()), 0.5 * weighted);
}

TEST(FilterExperiments, equal_gains_smooth_alike) {
  ComputeContext compute;
  WallExperiment experiment;
  experiment.frame_at = [](int) { return WallFrame{1.0, 0.0019}; };
  const double kalman = finalError(compute, "kalman", experiment);
  EXPECT_NEAR(finalError(compute, "weighted", experiment) / kalman, 1.0, 0.1);
  EXPECT_NEAR(finalError(compute, "average", experiment) / kalman, 1.0, 0.1);
}

}  // namespace
}  // namespace depth_fusion
