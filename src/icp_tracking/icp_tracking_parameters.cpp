#include "depth_fusion/icp_tracking/icp_tracking_parameters.h"

namespace depth_fusion {

ParameterTable IcpTrackingParameters::table() {
  const ParameterTable usual = {
      number("coarse_distance_m", &coarse_distance_m, 1e-4, 10.0,
             "largest distance between the points of a match at a quarter of the size: how far the prior may "
             "be off"),
      number("fine_distance_m", &fine_distance_m, 1e-4, 10.0,
             "largest distance between the points of a match at full size"),
      number("max_rmse_m", &max_rmse_m, 1e-5, 1.0,
             "a frame is lost if the RMS of its point-to-plane distances is larger"),
      number("max_translation_m", &max_translation_m, 1e-3, 100.0,
             "a frame is lost if its position differs from the prior's by more"),
      number("max_rotation_rad", &max_rotation_rad, 1e-3, 3.1416,
             "a frame is lost if its orientation differs from the prior's by more")};
  const ParameterTable iterations = {
      number("coarse_iterations", &coarse_iterations, 0, 100, "most iterations at a quarter of the size"),
      number("middle_iterations", &middle_iterations, 0, 100, "most iterations at half the size"),
      number("fine_iterations", &fine_iterations, 1, 100, "most iterations at full size"),
      number("convergence_rad", &convergence_rad, 0.0, 1.0,
             "rotation of a step below which the full size has converged; four times that at half of it, and "
             "so on"),
      number("convergence_m", &convergence_m, 0.0, 1.0,
             "translation of a step below which the full size has converged, with the same factors")};
  const ParameterTable matches = {
      number("fine_row_step", &fine_row_step, 1, 16,
             "rows from one that is matched to the next, at full size"),
      number("coarse_normal_angle_rad", &coarse_normal_angle_rad, 0.01, 1.5707,
             "largest angle between the normals of a match at a quarter of the size"),
      number("fine_normal_angle_rad", &fine_normal_angle_rad, 0.01, 1.5707,
             "largest angle between the normals of a match at full size"),
      number("huber_sigmas", &huber_sigmas, 0.1, 1000.0,
             "residual, in standard deviations of the sensor, from which a match's weight falls"),
      number("degeneracy_threshold", &degeneracy_threshold, 0.0, 1.0,
             "eigenvalue a match, in the unit cube, up to which a direction is left to the prior (the "
             "paper's theta); 0: none is"),
      number("correlated_points", &correlated_points, 1.0, 1e6,
             "matches that count as one measurement against a prior, for their errors are alike"),
      number("min_inlier_fraction", &min_inlier_fraction, 0.0, 1.0,
             "a frame is lost if a smaller part of its points is matched, of those that are seen where the "
             "map has a surface"),
      number("min_inliers", &min_inliers, 6, 100000000, "a frame is lost if fewer points are matched")};
  return joined({usual, expert(joined({iterations, matches}))});
}

}  // namespace depth_fusion
