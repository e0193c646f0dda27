// How the motion of the texture is found. The rows of table() say what each member means, in which unit and
// range.
#pragma once

#include "depth_fusion/common/parameters.h"

namespace depth_fusion {

struct TextureOdometryParameters {
  bool enabled = true;
  int levels = 3;
  int cell_size_px = 40;
  int features_per_cell = 3;
  int corner_threshold = 20;
  int weak_corner_threshold = 7;
  int min_features = 30;
  int min_matches = 20;
  int min_inliers = 15;
  float min_inlier_fraction = 0.15f;
  int max_descriptor_distance = 70;
  float search_radius_px = 120.0f;
  int ransac_iterations = 300;
  float coarse_inlier_px = 3.0f;
  float fine_inlier_px = 1.5f;
  float inlier_depth_sigmas = 4.0f;
  float shared_error = 0.06f;

  ParameterTable table();
};

}  // namespace depth_fusion
