// Parts of a calibration are applied if stretches of the recording confirm each other's.
#include "tools/calibration/calibration_parts.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

namespace depth_fusion {
namespace {

constexpr int kSegments = 10;
constexpr double kSigma = 0.002;  // of each parameter in a segment

// Segments that see the parameters of `truth`, each with the given error of its own.
std::vector<NormalEquations> segmentsOf(const ParameterVector& truth, double error_sigma) {
  std::vector<NormalEquations> segments(kSegments);
  cv::RNG random(5);
  for (NormalEquations& segment : segments) {
    ParameterVector seen = truth;
    for (double& value : seen) value += random.gaussian(error_sigma);
    segment.hessian = ParameterMatrix::Identity() / (kSigma * kSigma);
    segment.gradient = -segment.hessian * seen;
  }
  return segments;
}

ParameterMatrix weakPrior() { return ParameterMatrix::Identity() / (0.1 * 0.1); }

bool applied(const std::vector<PartVerdict>& verdicts, CalibrationPart part) {
  return verdicts[static_cast<size_t>(part)].applied;
}

// An offset of 10 mm at 1 m that is the same everywhere, and no other error.
ParameterVector commonOffset() {
  ParameterVector truth = ParameterVector::Constant(0.01);
  truth[kReadoutIndex] = 0.0;
  return truth;
}

TEST(CalibrationParts, OnlyWhatIsThereIsApplied) {
  const std::vector<NormalEquations> segments = segmentsOf(commonOffset(), kSigma);
  const ParameterMatrix prior = weakPrior();
  const SegmentedSystem system(segments, prior, ParameterVector::Zero(), ParameterVector::Zero());
  const std::vector<PartVerdict> verdicts = system.verdicts();
  EXPECT_TRUE(applied(verdicts, CalibrationPart::kMean));
  EXPECT_FALSE(applied(verdicts, CalibrationPart::kTilt));
  EXPECT_FALSE(applied(verdicts, CalibrationPart::kShape));
  EXPECT_FALSE(applied(verdicts, CalibrationPart::kReadout));
  const ParameterVector solution = system.solution(verdicts);
  EXPECT_NEAR(solution.head<kReadoutIndex>().mean(), 0.01, 0.001);
  EXPECT_LT((solution.head<kReadoutIndex>().array() - solution[0]).abs().maxCoeff(), 1e-5);
  EXPECT_NEAR(solution[kReadoutIndex], 0.0, 1e-6);
}

TEST(CalibrationParts, SegmentsThatContradictEachOtherChangeNothing) {
  const std::vector<NormalEquations> segments = segmentsOf(ParameterVector::Zero(), 20.0 * kSigma);
  const ParameterMatrix prior = weakPrior();
  ParameterVector defaults = ParameterVector::Zero();
  defaults[kReadoutIndex] = 0.002;
  const SegmentedSystem system(segments, prior, ParameterVector::Zero(), defaults);
  const std::vector<PartVerdict> verdicts = system.verdicts();
  for (const PartVerdict& verdict : verdicts) EXPECT_FALSE(verdict.applied);
  EXPECT_LT((system.solution(verdicts) - defaults).cwiseAbs().maxCoeff(), 1e-5);
  EXPECT_GT(system.sigmas().minCoeff(), kSigma);
}

TEST(CalibrationParts, TheStepIsFromWhereTheSegmentsAreLinearised) {
  ParameterVector truth = commonOffset();
  truth[kReadoutIndex] = 0.03;
  std::vector<NormalEquations> segments = segmentsOf(truth, 0.1 * kSigma);
  const ParameterVector at = ParameterVector::Constant(0.004);
  for (NormalEquations& segment : segments) segment.gradient += segment.hessian * at;
  const ParameterMatrix prior = weakPrior();
  const SegmentedSystem system(segments, prior, at, ParameterVector::Zero());
  const ParameterVector solution = system.solution(system.verdicts());
  EXPECT_NEAR(solution[kReadoutIndex], 0.03, 0.0005);
  EXPECT_NEAR(solution[0], 0.01, 0.0005);
}

}  // namespace
}  // namespace depth_fusion
