#include "depth_fusion/loops/loop_parameters.h"

namespace depth_fusion {

ParameterTable LoopParameters::table() {
  return {
      number("min_way_m", &min_way_m, 0.1, 1000.0,
             "a place that the sensor left less far back on its way is no loop"),
      number("index_features", &index_features, 20, 5000,
             "features of a keyframe that it is found by, 20 bytes of memory each"),
      number("max_candidates", &max_candidates, 1, 100, "places that are compared with each keyframe"),
      number("candidate_spacing_m", &candidate_spacing_m, 0.0, 100.0,
             "of keyframes nearer to each other on the way only the one most alike is compared"),
      number("max_descriptor_distance", &max_descriptor_distance, 0, 256,
             "features whose descriptors differ by more of their 256 bits are no pair"),
      number("max_descriptor_ratio", &max_descriptor_ratio, 0.1, 1.0,
             "nor are those whose difference is more than this part of that to the next best"),
      number("min_inliers", &min_inliers, 6, 10000, "pairs of features that must agree on one motion"),
      number("min_overlap", &min_overlap, 0.0, 1.0,
             "part of one of the two views that must lie on the surface of the other"),
      number("max_rmse_sigmas", &max_rmse_sigmas, 0.1, 100.0,
             "how far apart the surfaces may be, in standard deviations of the sensor"),
      number("max_contradicted", &max_contradicted, 0.0, 1.0,
             "part of the surface of one view that the other may see through"),
      number("max_disagreement_m", &max_disagreement_m, 0.001, 10.0,
             "how far depth may move a loop's pose from what the features say"),
      number("max_disagreement_rad", &max_disagreement_rad, 0.001, 3.1416, "and by how much it may turn it"),
      number("max_sigma_m", &max_sigma_m, 0.001, 10.0,
             "a loop whose position is less sure in some direction is not closed"),
      number("max_sigma_rad", &max_sigma_rad, 0.001, 3.1416, "nor is one that may be turned by more"),
      number("drift_m_per_m", &drift_m_per_m, 0.0, 1.0,
             "drift of the position, metres a metre of way (standard deviation)"),
      number("drift_rad_per_m", &drift_rad_per_m, 0.0, 1.0,
             "drift of the orientation, radians a metre of way"),
      number("drift_m_per_rad", &drift_m_per_rad, 0.0, 1.0, "drift of the position, metres a radian turned"),
      number("drift_rad_per_rad", &drift_rad_per_rad, 0.0, 1.0,
             "drift of the orientation, radians a radian turned"),
      number("correlated_way_m", &correlated_way_m, 0.1, 10000.0,
             "way, or radians turned, over which drift goes on in one direction; beyond, it grows with the "
             "root"),
      number("max_drift_sigmas", &max_drift_sigmas, 0.5, 100.0,
             "a loop that asks for a larger drift than so many of these standard deviations is not believed"),
      number("reach_m", &reach_m, 0.1, 1000.0, "from how far apart two cameras can see the same"),
      number("agreeing_loops", &agreeing_loops, 1, 100,
             "keyframes in a row whose loops must agree with each other before any is closed"),
      number("agreement_m", &agreement_m, 0.001, 10.0, "how far apart the positions that they say may be"),
      number("agreement_rad", &agreement_rad, 0.001, 3.1416,
             "and by how much they may differ in orientation"),
      number("agreement_way_m", &agreement_way_m, 0.1, 1000.0, "way within which they must lie"),
      number("loop_sigma_m", &loop_sigma_m, 0.0001, 1.0,
             "standard deviation of a closed loop's position, beside that of its fit"),
      number("loop_sigma_rad", &loop_sigma_rad, 0.0001, 1.0, "the same of its orientation"),
      number("max_closure_sigmas", &max_closure_sigmas, 0.5, 100.0,
             "a closure without which the graph is less strained by more standard deviations is undone"),
      number("gravity_sigma_rad", &gravity_sigma_rad, 0.0001, 1.0,
             "standard deviation of a measured direction of gravity")};
}

}  // namespace depth_fusion
