// How depth is aligned to the model view. The rows of table() say what each member means, in which unit and
// range.
#pragma once

#include "depth_fusion/common/parameters.h"

namespace depth_fusion {

struct IcpTrackingParameters {
  int coarse_iterations = 6;
  int middle_iterations = 5;
  int fine_iterations = 5;
  int fine_row_step = 2;
  float coarse_distance_m = 0.1f;
  float fine_distance_m = 0.04f;
  float coarse_normal_angle_rad = 0.8f;
  float fine_normal_angle_rad = 0.6f;
  float huber_sigmas = 2.0f;
  float convergence_rad = 1e-4f;
  float convergence_m = 1e-4f;
  float degeneracy_threshold = 0.001f;
  float correlated_points = 300.0f;
  float min_inlier_fraction = 0.25f;
  int min_inliers = 2000;
  float max_rmse_m = 0.02f;
  float max_translation_m = 0.3f;
  float max_rotation_rad = 0.5f;

  ParameterTable table();
};

}  // namespace depth_fusion
