#include "depth_fusion/tsdf_fusion/tsdf_fusion_parameters.h"

#include "tsdf_fusion/filter_options.h"

namespace depth_fusion {

ParameterTable TsdfFusionParameters::table() {
  return {
      atStartOnly(choice("rule", &rule, filterRules(), "how measurements change a voxel")),
      atStartOnly(
          choice("distance", &distance, filterDistances(),
                 "from a voxel to the surface: along its ray, to the plane that the ray hits, or to the "
                 "plane nearest to it")),
      number("gain_at_1m", &gain_at_1m, 1e-3, 1.0,
             "average: gain (the paper's w_k) of a measurement at 1 m; falls with the variance"),
      number("weight_at_1m", &weight_at_1m, 0.1, 255.0,
             "weighted: weight (w_k) of a measurement at 1 m; falls with the variance"),
      number("max_weight", &max_weight, 1.0, 255.0, "weighted: bound of a voxel's weight (W_max)"),
      number("process_sigma_m", &process_sigma_m, 0.0, 0.05,
             "kalman: how far a surface may move in a frame, the square root of Q"),
      number(
          "free_space_sigmas", &free_space_sigmas, 0.0, 100.0,
          "how far beyond the truncation the surface must be for a voxel to be free, in standard deviations"),
      number("free_space_rate", &free_space_rate, 0.0, 0.9,
             "part of its certainty that a free voxel loses a frame")};
}

std::vector<std::string> fusionRules() { return filterRules().names(); }

}  // namespace depth_fusion
