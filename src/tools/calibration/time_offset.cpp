#include "tools/calibration/time_offset.h"

#include <algorithm>
#include <cmath>

#include "depth_fusion/common/percentile.h"
#include "depth_fusion/recording/trajectory_file.h"
#include "tools/calibration/calibration_system.h"

namespace depth_fusion {
namespace {

constexpr double kMaxPoseGap_s = 0.1;
constexpr double kDifference_s = 0.1;  // for the acceleration, whose noise falls with it
// Noise alone gives three components an acceleration with this square, in squares of the residuals' sigma.
constexpr double kNoiseCurvature = 3.0 * 0.27 / (kDifference_s * kDifference_s);
constexpr double kMinCurvature = 3.0;  // times that of noise
constexpr double kMaxOffset_s = 0.2;
constexpr double kMaxSigma_s = 0.008;
constexpr double kMethodSigma_s = 0.003;  // what the method itself is off by, found on simulated recordings
constexpr double kCutoff_sigmas = 4.0;
constexpr double kSigmasPerMedian = 0.65;  // of the length of three normal components
constexpr size_t kMinMotions = 30;
constexpr int kSteps = 15;
constexpr int kOffsetSegments = 10;

// Holds by how much a motion differs, and how the trajectory's motion would change with the offset.
struct Difference {
  Vector6d residual, by_offset;
};

std::optional<Pose> motionBetween(const Trajectory& trajectory, double from_s, double to_s) {
  const auto from = poseAt(trajectory, from_s, kMaxPoseGap_s);
  const auto to = poseAt(trajectory, to_s, kMaxPoseGap_s);
  if (!from || !to) return std::nullopt;
  return from->inverse() * *to;
}

std::optional<Difference> differenceAt(const MeasuredMotion& motion, const Trajectory& trajectory,
                                       double offset_s) {
  const auto between = [&](double shift_s) {
    return motionBetween(trajectory, motion.from_s + offset_s + shift_s, motion.to_s + offset_s + shift_s);
  };
  const auto now = between(0.0), before = between(-kDifference_s), after = between(kDifference_s);
  if (!now || !before || !after) return std::nullopt;
  return Difference{twistFromPose(now->inverse() * motion.T_from_to),
                    (twistFromPose(*after) - twistFromPose(*before)) / (2.0 * kDifference_s)};
}

// The sigma of the residuals' rotations (first = 0) or translations (3).
double sigmaOf(const std::vector<Difference>& differences, int first) {
  std::vector<double> lengths;
  for (const Difference& difference : differences)
    lengths.push_back(difference.residual.segment<3>(first).norm());
  return std::max(kSigmasPerMedian * percentile(lengths, 0.5), 1e-9);
}

struct Step {
  double offset_s = 0.0, sigma_s = 0.0;
  bool speed_changes = false;  // by more than noise
};

Step stepOf(const std::vector<Difference>& differences) {
  std::array<double, kOffsetSegments> pulls{};
  double curvature = 0.0, noise = 0.0;
  const double sigmas[] = {sigmaOf(differences, 0), sigmaOf(differences, 3)};
  for (size_t i = 0; i < differences.size(); ++i) {
    for (int part = 0; part < 2; ++part) {
      const Eigen::Vector3d residual = differences[i].residual.segment<3>(3 * part) / sigmas[part];
      const Eigen::Vector3d by_offset = differences[i].by_offset.segment<3>(3 * part) / sigmas[part];
      const double weight = tukeyWeight(residual.norm(), kCutoff_sigmas * std::sqrt(3.0));
      pulls[i * kOffsetSegments / differences.size()] += weight * residual.dot(by_offset);
      curvature += weight * by_offset.squaredNorm();
      noise += weight * kNoiseCurvature;
    }
  }
  Step step;
  step.speed_changes = curvature > kMinCurvature * noise;
  curvature = std::max(curvature - noise, 0.5 * curvature);
  for (const double pull : pulls) step.offset_s += pull / curvature;
  for (const double pull : pulls)
    step.sigma_s += std::pow(pull / curvature - step.offset_s / kOffsetSegments, 2);
  step.sigma_s =
      std::hypot(std::sqrt(step.sigma_s * kOffsetSegments / (kOffsetSegments - 1.0)), kMethodSigma_s);
  return step;
}

}  // namespace

TimeOffset findTimeOffset(const std::vector<MeasuredMotion>& motions, const Trajectory& trajectory) {
  TimeOffset result;
  bool speed_changes = false;
  for (int i = 0; i < kSteps; ++i) {
    std::vector<Difference> differences;
    for (const MeasuredMotion& motion : motions) {
      if (const auto difference = differenceAt(motion, trajectory, result.offset_s.value))
        differences.push_back(*difference);
    }
    if (differences.size() < kMinMotions) {
      result.reason = "only " + std::to_string(differences.size()) + " motions of both at the same time";
      return result;
    }
    const Step step = stepOf(differences);
    result.offset_s = {result.offset_s.value + step.offset_s, step.sigma_s};
    speed_changes = step.speed_changes;
    if (!(std::abs(result.offset_s.value) < kMaxOffset_s)) {
      result.reason = "the motions do not match within 0.2 s";
      return result;
    }
  }
  result.found = speed_changes && result.offset_s.sigma < kMaxSigma_s;
  if (!result.found) result.reason = "the sensor's speed changes too little";
  return result;
}

}  // namespace depth_fusion
