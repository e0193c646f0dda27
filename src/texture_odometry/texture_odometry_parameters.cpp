#include "depth_fusion/texture_odometry/texture_odometry_parameters.h"

namespace depth_fusion {

ParameterTable TextureOdometryParameters::table() {
  return {
      {"enabled", &enabled, 0, 1, "false: ICP starts from the last pose"},
      {"levels", &levels, 1, 6, "of the image pyramid; coarse ones help against motion blur"},
      {"cell_size_px", &cell_size_px, 8, 1000, "of the grid that spreads the features"},
      {"features_per_cell", &features_per_cell, 1, 100, "the strongest corners of a cell"},
      {"corner_threshold", &corner_threshold, 1, 255, "brightness step of a corner (FAST)"},
      {"weak_corner_threshold", &weak_corner_threshold, 1, 255, "the same in cells with no corner"},
      {"min_features", &min_features, 3, 100000, "of a frame; no motion below"},
      {"min_matches", &min_matches, 3, 100000, "with depth in one frame at least; no motion below"},
      {"min_inliers", &min_inliers, 6, 100000, "no motion below"},
      {"min_inlier_fraction", &min_inlier_fraction, 0.0, 1.0, "of the matches; no motion below"},
      {"max_descriptor_distance", &max_descriptor_distance, 0, 256, "differing bits of a match"},
      {"search_radius_px", &search_radius_px, 1.0, 10000.0, "how far a feature moves between frames at most"},
      {"ransac_iterations", &ransac_iterations, 1, 100000, "most samples of three matches"},
      {"coarse_inlier_px", &coarse_inlier_px, 0.1, 100.0, "reprojection error of an inlier in RANSAC"},
      {"fine_inlier_px", &fine_inlier_px, 0.05, 100.0, "the same once the patches are aligned"},
      {"inlier_depth_sigmas", &inlier_depth_sigmas, 0.5, 100.0,
       "depth error of an inlier in standard deviations of the sensor"},
      {"sigma_scale", &sigma_scale, 0.1, 1000.0,
       "factor on the motion's standard deviations, for errors that the matches share"}};
}

}  // namespace depth_fusion
