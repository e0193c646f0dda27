// Pairs of features that look alike.
#pragma once

#include "depth_fusion/frames/frame_features.h"

namespace depth_fusion {

struct FeatureMatch {
  int reference = 0;  // indices of features
  int current = 0;
};

// Pairs features that are each other's nearest by descriptor, among those of the same level within
// search_radius_px (pixels of the full image).
std::vector<FeatureMatch> matchFeatures(const std::vector<Feature>& reference,
                                        const std::vector<Feature>& current, double search_radius_px,
                                        int max_descriptor_distance);

}  // namespace depth_fusion
