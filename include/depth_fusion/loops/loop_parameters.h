// How loops are found, believed and closed. The rows of table() say what each member means, in which unit and
// range.
#pragma once

#include "depth_fusion/common/parameters.h"

namespace depth_fusion {

struct LoopParameters {
  float keyframe_distance_m = 0.3f;
  float keyframe_angle_rad = 0.3f;
  int view_width_px = 320;
  float view_distance_m = 0.1f;
  float view_angle_rad = 0.1f;
  float min_way_m = 3.0f;
  int index_features = 300;
  int max_candidates = 6;
  float candidate_spacing_m = 1.0f;
  int max_descriptor_distance = 70;
  float max_descriptor_ratio = 0.9f;
  int min_inliers = 12;
  float min_overlap = 0.3f;
  float max_rmse_sigmas = 2.0f;
  float max_contradicted = 0.1f;
  float max_disagreement_m = 0.1f;
  float max_disagreement_rad = 0.06f;
  float max_sigma_m = 0.03f;
  float max_sigma_rad = 0.02f;
  float drift_m_per_m = 0.01f;
  float drift_rad_per_m = 0.003f;
  float drift_m_per_rad = 0.01f;
  float drift_rad_per_rad = 0.01f;
  float correlated_way_m = 10.0f;
  float max_drift_sigmas = 5.0f;
  float reach_m = 8.0f;
  int agreeing_loops = 3;
  float agreement_m = 0.08f;
  float agreement_rad = 0.05f;
  float agreement_way_m = 5.0f;
  float loop_sigma_m = 0.02f;
  float loop_sigma_rad = 0.01f;
  float max_closure_sigmas = 6.0f;
  float gravity_sigma_rad = 0.02f;
  float least_move_m = 0.03f;

  ParameterTable table();
};

}  // namespace depth_fusion
