#include "depth_fusion/frames/depth_sensor.h"

#include <algorithm>
#include <cmath>

namespace depth_fusion {

ParameterTable DepthSensorParameters::table() {
  return {number("sigma_base_m", &sigma_base_m, 1e-6, 1.0,
                 "smallest axial sigma: sigma(z) = base + growth (z - from)^2"),
          number("sigma_growth_per_m", &sigma_growth_per_m, 1e-6, 1.0, "growth of the axial sigma"),
          number("sigma_from_m", &sigma_from_m, 0.0, 100.0, "depth from which on the axial sigma grows"),
          number("lateral_sigma_px", &lateral_sigma_px, 0.0, 10.0,
                 "how far beside its ray a pixel measures; adds noise where the surface is slanted"),
          number("edge_sigmas", &edge_sigmas, 1.0, 100.0, "factor on the axial sigma beside depth edges"),
          number("max_sigma_m", &max_sigma_m, 1e-6, 1000.0, "depth whose axial sigma is larger is left out")};
}

float DepthSensorParameters::maxRange_m() const {
  return sigma_from_m + std::sqrt(std::max(max_sigma_m - sigma_base_m, 0.0f) / sigma_growth_per_m);
}

}  // namespace depth_fusion
