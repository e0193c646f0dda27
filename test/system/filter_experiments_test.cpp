// The paper's comparison of the filters, through the real kernels.
#include <gtest/gtest.h>

#include <cstdio>

#include "tools/evaluation/wall_experiment.h"

namespace depth_fusion {
namespace {

constexpr double kGain = 0.05;
constexpr int kSeeds = 5;

// The error of the last 10 % of the frames, over all seeds. The Kalman filter is told of the noise.
double finalError(ComputeContext& compute, const std::string& rule, WallExperiment experiment,
                  int seeds = 1) {
  experiment.told_of_noise = rule == "kalman";
  experiment.first_measured_frame = experiment.frames - experiment.frames / 10;
  std::vector<WallError> errors;
  for (experiment.seed = 0; experiment.seed < seeds; ++experiment.seed) {
    const auto of_seed =
        runWallExperiment(compute, experiment, filterOfGain(rule, kGain, experiment.first_sigma_m));
    std::printf("%s, seed %d: %.3f mm, %zu columns in the last frame\n", rule.c_str(), experiment.seed,
                1000.0 * rootMeanSquare(of_seed, 0), of_seed.back().columns);
    errors.insert(errors.end(), of_seed.begin(), of_seed.end());
  }
  return rootMeanSquare(errors, 0);
}

// Between equilibria, the error would be lower by the square root of the noise's growth, 0.56; measured 0.59.
TEST(FilterExperiments, growing_noise_hurts_the_kalman_filter_less) {
  ComputeContext compute;
  const double weighted = finalError(compute, "weighted", growingNoise(), kSeeds);
  const double kalman = finalError(compute, "kalman", growingNoise(), kSeeds);
  std::printf("kalman %.3f mm, weighted %.3f mm, ratio %.3f\n", 1000.0 * kalman, 1000.0 * weighted,
              kalman / weighted);
  EXPECT_LE(kalman, 0.65 * weighted);
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
