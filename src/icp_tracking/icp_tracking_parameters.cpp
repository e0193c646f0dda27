#include "depth_fusion/icp_tracking/icp_tracking_parameters.h"

namespace depth_fusion {

ParameterTable IcpTrackingParameters::table() {
  return {{"coarse_iterations", &coarse_iterations, 0, 100, "most iterations at a quarter of the size"},
          {"middle_iterations", &middle_iterations, 0, 100, "most iterations at half the size"},
          {"fine_iterations", &fine_iterations, 1, 100, "most iterations at full size"},
          {"fine_row_step", &fine_row_step, 1, 16, "rows from one that is matched to the next, at full size"},
          {"coarse_distance_m", &coarse_distance_m, 1e-4, 10.0,
           "largest distance of a match at a quarter of the size"},
          {"fine_distance_m", &fine_distance_m, 1e-4, 10.0, "largest distance of a match at full size"},
          {"coarse_normal_angle_rad", &coarse_normal_angle_rad, 0.01, 1.5707,
           "largest angle between the normals of a match at a quarter of the size"},
          {"fine_normal_angle_rad", &fine_normal_angle_rad, 0.01, 1.5707, "the same at full size"},
          {"huber_sigmas", &huber_sigmas, 0.1, 1000.0,
           "residual, in standard deviations of the sensor, from which a match's weight falls"},
          {"degeneracy_threshold", &degeneracy_threshold, 0.0, 1.0,
           "eigenvalue a match, in the unit cube, up to which a direction is left to the prior (the paper's "
           "theta)"},
          {"correlated_points", &correlated_points, 1.0, 1e6,
           "matches that count as one measurement against a prior, for their errors are alike"},
          {"convergence_rad", &convergence_rad, 0.0, 1.0,
           "rotation of a step below which the full size has converged; four times that at half of it, and "
           "so on"},
          {"convergence_m", &convergence_m, 0.0, 1.0, "the same for the translation"},
          {"min_inlier_fraction", &min_inlier_fraction, 0.0, 1.0, "of the frame's points; lost below"},
          {"min_inliers", &min_inliers, 6, 100000000, "matches; lost below"},
          {"max_rmse_m", &max_rmse_m, 1e-5, 1.0, "point-to-plane; lost above"},
          {"max_translation_m", &max_translation_m, 1e-3, 100.0, "against the prior; lost above"},
          {"max_rotation_rad", &max_rotation_rad, 1e-3, 3.1416, "against the prior; lost above"}};
}

}  // namespace depth_fusion
