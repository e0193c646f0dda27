// How meshes are textured. The rows of table() say what each member means, in which unit and range.
#pragma once

#include "depth_fusion/common/parameters.h"

namespace depth_fusion {

struct TexturingParameters {
  int max_views = 200;
  float view_distance_m = 0.1f;
  float view_angle_rad = 0.15f;
  int alignment_rounds = 10;
  int alignment_points = 60000;
  float max_incidence_rad = 1.3f;
  float hidden_ratio = 0.02f;
  float outlier_levels = 30.0f;
  float smoothness = 0.3f;
  float seam_stiffness = 0.1f;
  int page_px = 4096;

  ParameterTable table();
};

}  // namespace depth_fusion
