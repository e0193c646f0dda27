// What the nodelet surface_mesh is told.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "depth_fusion/surface_mesh/surface_mesh_parameters.h"
#include "depth_fusion/texturing/texturing_parameters.h"
#include "ros/output/live_surface_parameters.h"

namespace depth_fusion {

struct SurfaceMeshNodeletParameters {
  SurfaceMeshParameters mesh;
  LiveSurfaceParameters live;
  TexturingParameters texturing;
  std::string map;  // the nodelet's resolved name
  float publish_rate_hz = 2.0f;
  float points_rate_hz = 1.0f;

  ParameterTable table();
  // By the names of the stages.
  std::vector<std::pair<std::string, ParameterTable>> stages();
};

}  // namespace depth_fusion
