#include "depth_fusion/frames/depth_sensor.h"

#include <algorithm>
#include <cmath>

namespace depth_fusion {

ParameterTable DepthSensorParameters::table() {
  return {{"sigma_base_m", &sigma_base_m, 1e-6, 1.0, "axial sigma: base + growth (z - from)^2"},
          {"sigma_growth_per_m", &sigma_growth_per_m, 1e-6, 1.0, "the growth of the axial sigma"},
          {"sigma_from_m", &sigma_from_m, 0.0, 100.0, "the depth from which on the axial sigma grows"},
          {"lateral_sigma_px", &lateral_sigma_px, 0.0, 10.0,
           "how far beside its ray a pixel measures; adds noise where the surface is slanted"},
          {"edge_sigmas", &edge_sigmas, 1.0, 100.0, "beside depth edges, times the axial sigma"},
          {"max_sigma_m", &max_sigma_m, 1e-6, 1000.0, "depth whose axial sigma is larger is left out"}};
}

float DepthSensorParameters::maxRange_m() const {
  return sigma_from_m + std::sqrt(std::max(max_sigma_m - sigma_base_m, 0.0f) / sigma_growth_per_m);
}

}  // namespace depth_fusion
