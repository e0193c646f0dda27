#include "texture_odometry/feature_matching.h"

#include <cstdlib>

#include "texture_odometry/brief.h"

namespace depth_fusion {
namespace {

struct Nearest {
  int index = -1;
  int distance = 257;

  void offer(int candidate, int candidate_distance) {
    if (candidate_distance < distance) *this = {candidate, candidate_distance};
  }
};

}  // namespace

std::vector<FeatureMatch> matchFeatures(const std::vector<Feature>& reference,
                                        const std::vector<Feature>& current, double search_radius_px,
                                        int max_descriptor_distance) {
  std::vector<Nearest> of_reference(reference.size()), of_current(current.size());
  for (size_t i = 0; i < reference.size(); ++i) {
    const Feature& a = reference[i];
    const int radius = static_cast<int>(search_radius_px) >> a.level;
    for (size_t j = 0; j < current.size(); ++j) {
      const Feature& b = current[j];
      if (std::abs(a.pixel.x - b.pixel.x) > radius || std::abs(a.pixel.y - b.pixel.y) > radius) continue;
      if (a.level != b.level) continue;
      const int distance = hammingDistance(a.descriptor, b.descriptor);
      of_reference[i].offer(static_cast<int>(j), distance);
      of_current[j].offer(static_cast<int>(i), distance);
    }
  }
  std::vector<FeatureMatch> matches;
  for (size_t i = 0; i < reference.size(); ++i) {
    const auto& [j, distance] = of_reference[i];
    if (j < 0 || distance > max_descriptor_distance || of_current[j].index != static_cast<int>(i)) continue;
    matches.push_back({static_cast<int>(i), j});
  }
  return matches;
}

}  // namespace depth_fusion
