// What a kernel needs to know of the depth sensor.
#pragma once

#include "depth_fusion/frames/depth_sensor.h"
#include "shared/types.h"

namespace depth_fusion {

inline SensorArgs toArgs(const DepthSensorParameters& sensor) {
  return {sensor.sigma_base_m, sensor.sigma_growth_per_m, sensor.sigma_from_m, sensor.lateral_sigma_px,
          sensor.edge_sigmas};
}

}  // namespace depth_fusion
