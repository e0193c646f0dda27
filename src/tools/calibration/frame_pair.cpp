#include "tools/calibration/frame_pair.h"

#include <cmath>

#include "shared/types.h"

namespace depth_fusion {
namespace {

using Eigen::Vector3d;

constexpr int kPoseSteps = 4;
constexpr int kCoarseColumns = 40;
constexpr int kFineColumns = 80;
constexpr double kMaxDistance_m = 0.1;
constexpr double kMinNormalCosine = 0.85;
constexpr double kMinMatchedPart = 0.2;
constexpr size_t kMinMatches = 200;

// Derivatives and weights are those of the mean of both points, whose noise does not correlate with that of
// the residual. Taken at either point, they would correlate, and the least squares would prefer depth that
// shrinks.
struct PointMatch {
  ViewPoint a, b;  // moved to their mean along their rays
  Vector3d normal_A;
  double residual_m, sigma_m;
};

// Returns the variance of a point across the plane; the noise itself is along the ray.
double varianceAcross(const ViewPoint& point, const Vector3d& normal) {
  return std::pow(point.sigma_m * normal.dot(point.p_D) / point.p_D.z(), 2);
}

void moveToMean(PointMatch& match, const DepthSensorParameters& sensor) {
  const Vector3d& normal_B = match.b.normal_D;
  const double variance_a = varianceAcross(match.a, match.normal_A),
               variance_b = varianceAcross(match.b, normal_B);
  const double of_a_m = match.residual_m * variance_a / (variance_a + variance_b);
  const double of_b_m = match.residual_m - of_a_m;
  match.a.p_D *= 1.0 - of_a_m / match.normal_A.dot(match.a.p_D);
  match.b.p_D *= 1.0 + of_b_m / normal_B.dot(match.b.p_D);
  for (ViewPoint* point : {&match.a, &match.b}) point->sigma_m = AXIAL_SIGMA_M(sensor, point->p_D.z());
  match.sigma_m = std::hypot(match.a.sigma_m, match.b.sigma_m);
}

std::vector<PointMatch> matchPoints(const std::vector<ViewPoint>& points_A, const CalibrationView& b,
                                    const Pose& T_B_A) {
  std::vector<PointMatch> matches;
  for (const ViewPoint& point : points_A) {
    const Vector3d p_B = T_B_A * point.p_D;
    const auto other = b.under(p_B);
    if (!other || (p_B - other->p_D).norm() > kMaxDistance_m) continue;
    const Vector3d normal_A = T_B_A.linear().transpose() * other->normal_D;
    if (point.normal_D.dot(normal_A) < kMinNormalCosine) continue;
    matches.push_back({point, *other, normal_A, other->normal_D.dot(p_B - other->p_D), 0.0});
    moveToMean(matches.back(), b.sensor());
  }
  const double needed = kMinMatchedPart * static_cast<double>(points_A.size());
  const bool enough = matches.size() >= kMinMatches && static_cast<double>(matches.size()) >= needed;
  return enough ? matches : std::vector<PointMatch>();
}

double weightOf(const PointMatch& match, double cutoff_sigmas) {
  return tukeyWeight(match.residual_m / match.sigma_m, cutoff_sigmas) / (match.sigma_m * match.sigma_m);
}

// The derivative by the twist that is applied to T_B_A on the left.
Vector6d byPose(const PointMatch& match) {
  Vector6d derivative;
  derivative << match.b.p_D.cross(match.b.normal_D), match.b.normal_D;
  return derivative;
}

}  // namespace

std::optional<PairResult> matchPair(const CalibrationView& a, const CalibrationView& b, const Pose& T_B_A,
                                    double cutoff_sigmas) {
  PairResult result;
  result.T_B_A = T_B_A;
  const std::vector<ViewPoint> coarse = a.sample(kCoarseColumns);
  for (int step = 0; step < kPoseSteps; ++step) {
    LocalSystem<6> system;
    const std::vector<PointMatch> matches = matchPoints(coarse, b, result.T_B_A);
    if (matches.empty()) return std::nullopt;
    for (const PointMatch& match : matches) {
      system.add(byPose(match), {}, match.residual_m, weightOf(match, cutoff_sigmas));
    }
    result.T_B_A = orthonormalized(poseFromTwist(system.localStep()) * result.T_B_A);
  }
  LocalSystem<6> system;
  for (const PointMatch& match : matchPoints(a.sample(kFineColumns), b, result.T_B_A)) {
    const double weight = weightOf(match, cutoff_sigmas);
    SparseRow row;
    a.addDerivatives(match.a, match.normal_A, row);
    b.addDerivatives(match.b, -match.b.normal_D, row);
    system.add(byPose(match), row, match.residual_m, weight);
  }
  result.equations = system.eliminated();
  return result;
}

}  // namespace depth_fusion
