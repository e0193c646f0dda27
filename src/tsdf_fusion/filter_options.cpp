#include "tsdf_fusion/filter_options.h"

#include "depth_fusion/common/error.h"
#include "shared/types.h"

namespace depth_fusion {
namespace {

struct NamedOption {
  std::string name;
  int value;  // of the kernels' macro
};
using NamedOptions = std::vector<NamedOption>;

const NamedOptions& ruleOptions() {
  static const NamedOptions options = {
      {"kalman", FUSION_KALMAN}, {"weighted", FUSION_WEIGHTED}, {"average", FUSION_AVERAGE}};
  return options;
}

const NamedOptions& distanceOptions() {
  static const NamedOptions options = {
      {"projective", DISTANCE_PROJECTIVE}, {"plane", DISTANCE_PLANE}, {"refined", DISTANCE_REFINED}};
  return options;
}

std::vector<std::string> namesOf(const NamedOptions& options) {
  std::vector<std::string> names;
  for (const NamedOption& option : options) names.push_back(option.name);
  return names;
}

std::string define(const std::string& macro, const NamedOptions& options, const std::string& name) {
  for (const NamedOption& option : options) {
    if (option.name == name) return " -D" + macro + "=" + std::to_string(option.value);
  }
  throw Error("'" + name + "' is no value of " + macro);
}

}  // namespace

std::vector<std::string> fusionRules() { return namesOf(ruleOptions()); }

std::vector<std::string> fusionDistances() { return namesOf(distanceOptions()); }

std::string filterOptions(const TsdfFusionParameters& parameters) {
  return define("FUSION_RULE", ruleOptions(), parameters.rule) +
         define("FUSION_DISTANCE", distanceOptions(), parameters.distance);
}

}  // namespace depth_fusion
