// How far an estimated trajectory is from the true one.
#pragma once

#include "depth_fusion/geometry/pose.h"
#include "tools/evaluation/statistics.h"

namespace depth_fusion {

// Pairs an estimated pose with the true one of the same moment, both in the truth's world.
struct PosePair {
  double stamp_s = 0.0;
  Pose T_W_estimate = Pose::Identity();  // aligned
  Pose T_W_truth = Pose::Identity();
};

// What the estimated motion between two moments does beyond the true one, in the later camera's frame.
Pose motionError(const PosePair& from, const PosePair& to);

struct TrajectoryError {
  Pose T_W_E =
      Pose::Identity();  // maps the estimate's world into the truth's: the rigid alignment, without scale
  std::vector<PosePair> pairs;
  size_t estimated_poses = 0;
  ErrorStatistics ate_m;              // absolute trajectory error: distance of the positions after alignment
  ErrorStatistics rpe_translation_m;  // relative pose error over rpe_interval_s
  ErrorStatistics rpe_rotation_deg;
};

struct TrajectoryErrorOptions {
  double max_gap_s = 0.05;  // the truth is interpolated at an estimate's stamp if it has poses this near
  double rpe_interval_s = 1.0;
};

// Throws Error if fewer than three poses have a true one.
TrajectoryError compareTrajectories(const Trajectory& estimate, const Trajectory& truth,
                                    const TrajectoryErrorOptions& options = {});

}  // namespace depth_fusion
