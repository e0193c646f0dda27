// What the nodelet navigation is told.
#pragma once

#include <string>

#include "depth_fusion/esdf/esdf_parameters.h"
#include "ros/output/navigation_parameters.h"

namespace depth_fusion {

struct NavigationNodeletParameters {
  EsdfParameters esdf;
  NavigationParameters navigation;
  std::string map;  // the nodelet's resolved name
  float publish_rate_hz = 5.0f;
  float keep_s = 30.0f;

  // The nodelet's own rows.
  ParameterTable table();
};

}  // namespace depth_fusion
