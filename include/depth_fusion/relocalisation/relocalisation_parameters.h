// How a lost sensor is found again. The rows of table() say what each member means, in which unit and range.
#pragma once

#include "depth_fusion/common/parameters.h"

namespace depth_fusion {

struct RelocalisationParameters {
  float keyframe_distance_m = 0.2f;
  float keyframe_angle_rad = 0.25f;
  int max_keyframes = 200;
  int max_candidates = 5;
  float min_inlier_fraction = 0.3f;
  int young_map_frames = 5;
  int give_up_after_frames = 15;
  float lost_s = 10.0f;

  ParameterTable table();
};

}  // namespace depth_fusion
