#include "tools/evaluation/trajectory_error.h"

#include <cstdio>

#include "depth_fusion/common/error.h"
#include "depth_fusion/geometry/angles.h"
#include "depth_fusion/recording/trajectory_file.h"

namespace depth_fusion {
namespace {

std::vector<PosePair> pairsOf(const Trajectory& estimate, const Trajectory& truth, double max_gap_s) {
  std::vector<PosePair> pairs;
  for (const StampedPose& pose : estimate) {
    const std::optional<Pose> T_W_truth = poseAt(truth, pose.stamp_s, max_gap_s);
    if (T_W_truth) pairs.push_back({pose.stamp_s, pose.T_W_D, *T_W_truth});
  }
  return pairs;
}

std::string spanText(const Trajectory& trajectory) {
  char text[80];
  std::snprintf(text, sizeof(text), "%.3f to %.3f s", trajectory.front().stamp_s, trajectory.back().stamp_s);
  return text;
}

// Finds the rigid motion that brings the estimated positions nearest to the true ones (Umeyama without
// scale).
Pose alignment(const std::vector<PosePair>& pairs) {
  Eigen::Matrix3Xd estimate(3, pairs.size()), truth(3, pairs.size());
  for (size_t i = 0; i < pairs.size(); ++i) {
    estimate.col(i) = pairs[i].T_W_estimate.translation();
    truth.col(i) = pairs[i].T_W_truth.translation();
  }
  return Pose(Eigen::umeyama(estimate, truth, false));
}

ErrorStatistics absoluteError(const std::vector<PosePair>& pairs) {
  std::vector<double> errors_m;
  for (const PosePair& pair : pairs) {
    errors_m.push_back((pair.T_W_estimate.translation() - pair.T_W_truth.translation()).norm());
  }
  return statisticsOf(errors_m);
}

void addRelativeError(const TrajectoryErrorOptions& options, TrajectoryError& error) {
  Trajectory estimate, truth;
  for (const PosePair& pair : error.pairs) {
    estimate.push_back({pair.stamp_s, pair.T_W_estimate});
    truth.push_back({pair.stamp_s, pair.T_W_truth});
  }
  std::vector<double> translations_m, rotations_deg;
  for (const PosePair& pair : error.pairs) {
    const double end_s = pair.stamp_s + options.rpe_interval_s;
    const std::optional<Pose> estimate_end = poseAt(estimate, end_s, options.max_gap_s);
    const std::optional<Pose> truth_end = poseAt(truth, end_s, options.max_gap_s);
    if (!estimate_end || !truth_end) continue;
    const Pose difference = motionError(pair, {end_s, *estimate_end, *truth_end});
    translations_m.push_back(difference.translation().norm());
    rotations_deg.push_back(rotationAngle(difference) * kDegPerRad);
  }
  error.rpe_translation_m = statisticsOf(translations_m);
  error.rpe_rotation_deg = statisticsOf(rotations_deg);
}

}  // namespace

Pose motionError(const PosePair& from, const PosePair& to) {
  const Pose true_motion = from.T_W_truth.inverse() * to.T_W_truth;
  return true_motion.inverse() * (from.T_W_estimate.inverse() * to.T_W_estimate);
}

TrajectoryError compareTrajectories(const Trajectory& estimate, const Trajectory& truth,
                                    const TrajectoryErrorOptions& options) {
  check(!estimate.empty(), "the estimated trajectory has no poses");
  check(!truth.empty(), "the ground truth has no poses");
  TrajectoryError error;
  error.estimated_poses = estimate.size();
  error.pairs = pairsOf(estimate, truth, options.max_gap_s);
  check(error.pairs.size() >= 3, "only " + std::to_string(error.pairs.size()) + " of " +
                                     std::to_string(estimate.size()) + " estimated poses (" +
                                     spanText(estimate) + ") have a ground truth pose (" + spanText(truth) +
                                     ") at their time; three are needed: are these of the same recording?");
  error.T_W_E = alignment(error.pairs);
  for (PosePair& pair : error.pairs) pair.T_W_estimate = error.T_W_E * pair.T_W_estimate;
  error.ate_m = absoluteError(error.pairs);
  addRelativeError(options, error);
  return error;
}

}  // namespace depth_fusion
