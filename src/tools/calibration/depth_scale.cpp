#include "tools/calibration/depth_scale.h"

#include <Eigen/Geometry>
#include <cmath>

#include "depth_fusion/common/error.h"
#include "depth_fusion/recording/trajectory_file.h"

namespace depth_fusion {
namespace {

constexpr double kMaxTruthGap_s = 0.05;
constexpr double kTrackedSigma_m = 0.005;  // of a pose that is tracked over a distance
constexpr double kMinDistance_m = 0.2;
constexpr int kScaleSegments = 10;
constexpr size_t kMinPoses = 50;

using Points = Eigen::Matrix3Xd;

// Returns the columns without those of one of the segments.
Points without(const Points& points, int segment) {
  const Eigen::Index begin = segment * points.cols() / kScaleSegments,
                     end = (segment + 1) * points.cols() / kScaleSegments;
  Points rest(3, points.cols() - (end - begin));
  rest << points.leftCols(begin), points.rightCols(points.cols() - end);
  return rest;
}

double scaleOf(const Points& tracked, const Points& truth) {
  return std::cbrt(Eigen::umeyama(tracked, truth).topLeftCorner<3, 3>().determinant());
}

}  // namespace

Estimate scaleAgainst(const Trajectory& tracked, const Trajectory& truth) {
  Points from(3, tracked.size()), to(3, tracked.size());
  Eigen::Index count = 0;
  for (const StampedPose& pose : tracked) {
    const auto true_pose = poseAt(truth, pose.stamp_s, kMaxTruthGap_s);
    if (!true_pose) continue;
    from.col(count) = pose.T_W_D.translation();
    to.col(count++) = true_pose->translation();
  }
  check(static_cast<size_t>(count) >= kMinPoses,
        "only " + std::to_string(count) + " tracked poses have a true one; the scale needs at least 50");
  from.conservativeResize(3, count);
  to.conservativeResize(3, count);
  Estimate scale{scaleOf(from, to), 0.0};
  for (int i = 0; i < kScaleSegments; ++i) {
    const double left_out = scaleOf(without(from, i), without(to, i)) - scale.value;
    scale.sigma += (kScaleSegments - 1.0) / kScaleSegments * left_out * left_out;
  }
  scale.sigma = std::sqrt(scale.sigma);
  return scale;
}

Estimate scaleAgainst(const Trajectory& tracked, const Estimate& distance_m) {
  check(distance_m.value >= kMinDistance_m,
        "a distance below 0.2 m says too little of the scale; measure a longer one");
  const double tracked_m = (tracked.back().T_W_D.translation() - tracked.front().T_W_D.translation()).norm();
  check(tracked_m > 0.5 * distance_m.value && tracked_m < 2.0 * distance_m.value,
        "the sensor moved by " + std::to_string(tracked_m) +
            " m from the first frame to the last, not by the " + std::to_string(distance_m.value) +
            " m of --distance");
  const double relative = std::hypot(distance_m.sigma / distance_m.value, kTrackedSigma_m / tracked_m);
  return {distance_m.value / tracked_m, distance_m.value / tracked_m * relative};
}

}  // namespace depth_fusion
