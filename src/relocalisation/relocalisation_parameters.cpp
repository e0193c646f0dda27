#include "depth_fusion/relocalisation/relocalisation_parameters.h"

namespace depth_fusion {

ParameterTable RelocalisationParameters::table() {
  return {
      {"keyframe_distance_m", &keyframe_distance_m, 0.001, 100.0, "between keyframes that see the same way"},
      {"keyframe_angle_rad", &keyframe_angle_rad, 0.001, 3.1416, "between keyframes at the same place"},
      {"max_keyframes", &max_keyframes, 0, 100000, "kept in memory, some 200 kB each; 0: no relocalisation"},
      {"max_candidates", &max_candidates, 1, 1000, "keyframes that a lost frame is matched to"},
      {"min_inlier_fraction", &min_inlier_fraction, 0.0, 1.0,
       "of a lost frame's points against the model view; still lost below"}};
}

}  // namespace depth_fusion
