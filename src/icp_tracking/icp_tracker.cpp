#include "depth_fusion/icp_tracking/icp_tracker.h"

#include <array>
#include <cmath>
#include <sstream>

#include "icp_tracking/icp_tracking_kernels.h"

namespace depth_fusion {
namespace {

// Why the result is not to be trusted, or nothing.
std::string lostReason(const TrackingResult& result, const IcpSystem& system, const Pose& T_prior_D,
                       const IcpTrackingParameters& parameters) {
  std::ostringstream reason;
  if (system.source_points < parameters.min_inliers) {
    reason << "only " << system.source_points << " points with depth and normal";
  } else if (result.inliers < parameters.min_inliers || result.inlier_fraction < parameters.min_inlier_fraction) {
    reason << "only " << result.inliers << " inliers, " << std::lround(100.0 * result.inlier_fraction)
           << " % of the points";
  } else if (!(result.rmse_m <= parameters.max_rmse_m)) {
    reason << "rmse " << result.rmse_m << " m";
  } else if (T_prior_D.translation().norm() > parameters.max_translation_m ||
             rotationAngle(T_prior_D) > parameters.max_rotation_rad) {
    reason << "jump of " << T_prior_D.translation().norm() << " m, " << rotationAngle(T_prior_D) << " rad";
  }
  return reason.str();
}

// Why the system has no solution.
std::string undeterminedReason(const IcpSystem& system) {
  if (system.source_points == 0.0) return "no points with depth and normal";
  if (system.inliers == 0.0) return "no point matches the view";
  return "the geometry seen does not determine the motion";
}

}  // namespace

ParameterTable IcpTrackingParameters::table() {
  return {
      {"coarse_iterations", &coarse_iterations, 0, 100, "most iterations at a quarter of the size"},
      {"middle_iterations", &middle_iterations, 0, 100, "most iterations at half the size"},
      {"fine_iterations", &fine_iterations, 1, 100, "most iterations at full size"},
      {"coarse_distance_m", &coarse_distance_m, 1e-4, 10.0, "largest distance of a match at a quarter of the size"},
      {"fine_distance_m", &fine_distance_m, 1e-4, 10.0, "largest distance of a match at full size"},
      {"max_normal_angle_rad", &max_normal_angle_rad, 0.01, 1.5707, "largest angle between the normals of a match"},
      {"convergence_rad", &convergence_rad, 0.0, 1.0, "rotation of a step below which a level has converged"},
      {"convergence_m", &convergence_m, 0.0, 1.0, "translation of a step below which a level has converged"},
      {"min_inlier_fraction", &min_inlier_fraction, 0.0, 1.0, "of the frame's points; lost below"},
      {"min_inliers", &min_inliers, 6, 100000000, "matches; lost below"},
      {"max_rmse_m", &max_rmse_m, 1e-5, 1.0, "point-to-plane; lost above"},
      {"max_translation_m", &max_translation_m, 1e-3, 100.0, "against the prior; lost above"},
      {"max_rotation_rad", &max_rotation_rad, 1e-3, 3.1416, "against the prior; lost above"}};
}

IcpTracker::IcpTracker(ComputeContext& compute, const IcpTrackingParameters& parameters,
                       const CameraIntrinsics& camera)
    : parameters_(parameters),
      partial_sums_(compute, camera.height * ICP_SUMS * sizeof(float), "ICP sums"),
      kernels_(std::make_unique<Kernels>(compute)) {
  validate(parameters_.table());
}

IcpTracker::~IcpTracker() = default;

TrackingResult IcpTracker::track(const DepthFrame& frame, const ModelView& view, const Pose& T_W_D_prior,
                                 StageTimers& timers) {
  const StageTimers::Scope timer(timers, "icp_tracking");
  const Pose T_M_W = view.T_W_D.inverse();
  const Pose T_M_prior = T_M_W * T_W_D_prior;
  const std::array<int, 3> iterations = {parameters_.fine_iterations, parameters_.middle_iterations,
                                         parameters_.coarse_iterations};
  const float distance_ratio = std::sqrt(parameters_.coarse_distance_m / parameters_.fine_distance_m);
  const float min_cosine = std::cos(parameters_.max_normal_angle_rad);

  TrackingResult result;
  IcpSystem system;
  Pose T_M_D = T_M_prior;
  for (int level = static_cast<int>(frame.levels.size()) - 1; level >= 0; --level) {
    const float max_distance_m = parameters_.fine_distance_m * std::pow(distance_ratio, static_cast<float>(level));
    for (int i = 0; i < iterations[level]; ++i) {
      system = kernels_->accumulateSystem(frame.levels[level], view, T_M_D, max_distance_m, min_cosine, partial_sums_);
      ++result.iterations;
      const std::optional<Vector6d> twist = solve(system);
      if (!twist) {
        result.reason = undeterminedReason(system);
        return result;
      }
      T_M_D = poseFromTwist(*twist) * T_M_D;
      if (twist->head<3>().norm() < parameters_.convergence_rad && twist->tail<3>().norm() < parameters_.convergence_m) {
        break;
      }
    }
  }
  result.inliers = static_cast<int>(system.inliers);
  result.inlier_fraction = system.source_points > 0.0 ? system.inliers / system.source_points : 0.0;
  result.rmse_m = system.rmse();
  result.T_W_D = orthonormalized(view.T_W_D * T_M_D);
  result.reason = lostReason(result, system, T_M_prior.inverse() * T_M_D, parameters_);
  result.status = result.reason.empty() ? TrackingStatus::kTracking : TrackingStatus::kLost;
  return result;
}

}  // namespace depth_fusion
