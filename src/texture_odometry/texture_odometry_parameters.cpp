#include "depth_fusion/texture_odometry/texture_odometry_parameters.h"

namespace depth_fusion {

ParameterTable TextureOdometryParameters::table() {
  const ParameterTable usual = {
      flag("enabled", &enabled, "false: ICP starts from the last pose"),
      number("levels", &levels, 1, 6, "levels of the image pyramid; coarse ones help against motion blur"),
      number("features_per_cell", &features_per_cell, 1, 100,
             "how many of a cell's strongest corners are kept"),
      number("corner_threshold", &corner_threshold, 1, 255,
             "brightness step, in grey values, of a corner (FAST)"),
      number("search_radius_px", &search_radius_px, 1.0, 10000.0,
             "how far a feature moves between frames at most")};
  const ParameterTable features = {
      number("cell_size_px", &cell_size_px, 8, 1000,
             "edge of the cells of the grid that spreads the features"),
      number("weak_corner_threshold", &weak_corner_threshold, 1, 255,
             "brightness step, in grey values, of a corner in cells that have none by corner_threshold"),
      number("min_features", &min_features, 3, 100000, "no motion is found in a frame with fewer features"),
      number("max_descriptor_distance", &max_descriptor_distance, 0, 256,
             "differing bits of a match's descriptors, at most")};
  const ParameterTable motion = {
      number("min_matches", &min_matches, 3, 100000,
             "no motion is found from fewer matches with depth in one frame at least"),
      number("min_inliers", &min_inliers, 6, 100000, "no motion is found from fewer inliers"),
      number("min_inlier_fraction", &min_inlier_fraction, 0.0, 1.0,
             "no motion is found if a smaller part of the matches are inliers"),
      number("ransac_iterations", &ransac_iterations, 1, 100000, "most samples of three matches"),
      number("coarse_inlier_px", &coarse_inlier_px, 0.1, 100.0,
             "largest reprojection error of an inlier in RANSAC"),
      number("fine_inlier_px", &fine_inlier_px, 0.05, 100.0,
             "largest reprojection error of an inlier once the patches are aligned"),
      number("inlier_depth_sigmas", &inlier_depth_sigmas, 0.5, 100.0,
             "largest depth error of an inlier in standard deviations of the sensor"),
      number("shared_error", &shared_error, 0.0, 1000.0,
             "how far the matches are off alike, as a part of how far they move: colour and depth of "
             "different moments, rows read one after the other")};
  return joined({usual, expert(joined({features, motion}))});
}

}  // namespace depth_fusion
