#include "tsdf_fusion/filter_options.h"

#include "shared/types.h"

namespace depth_fusion {

const Enumeration<int>& filterRules() {
  static const Enumeration<int> rules = {
      {"kalman", FUSION_KALMAN}, {"weighted", FUSION_WEIGHTED}, {"average", FUSION_AVERAGE}};
  return rules;
}

const Enumeration<int>& filterDistances() {
  static const Enumeration<int> distances = {
      {"projective", DISTANCE_PROJECTIVE}, {"plane", DISTANCE_PLANE}, {"refined", DISTANCE_REFINED}};
  return distances;
}

std::string filterOptions(const TsdfFusionParameters& parameters) {
  return " -DFUSION_RULE=" + std::to_string(filterRules().of(parameters.rule)) +
         " -DFUSION_DISTANCE=" + std::to_string(filterDistances().of(parameters.distance));
}

}  // namespace depth_fusion
