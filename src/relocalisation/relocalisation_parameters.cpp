#include "depth_fusion/relocalisation/relocalisation_parameters.h"

namespace depth_fusion {

ParameterTable RelocalisationParameters::table() {
  return {
      number("keyframe_distance_m", &keyframe_distance_m, 0.001, 100.0,
             "distance between keyframes that see the same way"),
      number("keyframe_angle_rad", &keyframe_angle_rad, 0.001, 3.1416,
             "angle between keyframes at the same place"),
      number(
          "max_keyframes", &max_keyframes, 0, 100000,
          "keyframes kept in memory, some 200 kB each, 300 with their pictures where the map has colour; 0: "
          "no relocalisation"),
      number("max_candidates", &max_candidates, 1, 1000, "keyframes that a lost frame is matched to"),
      number("min_inlier_fraction", &min_inlier_fraction, 0.0, 1.0,
             "a lost frame stays lost if a smaller part of its points matches the model view"),
      number("young_map_frames", &young_map_frames, 0, 100,
             "a map of so many frames at most begins anew if nothing fits it, or if its first frame was "
             "bent; 0: no map does"),
      number("give_up_after_frames", &give_up_after_frames, 1, 10000,
             "frames in a row that do not fit such a map, until it begins anew"),
      number(
          "lost_s", &lost_s, 0.0, 1e6,
          "a sensor that is lost for so long begins another part of the map, which a loop joins with "
          "the rest, where loops are sought and the image has texture; 0: it stays lost until it is found")};
}

}  // namespace depth_fusion
