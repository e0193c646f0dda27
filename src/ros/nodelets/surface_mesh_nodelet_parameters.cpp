#include "ros/nodelets/surface_mesh_nodelet_parameters.h"

namespace depth_fusion {

ParameterTable SurfaceMeshNodeletParameters::table() {
  const ParameterTable own = {
      atStartOnly(text("map", &map, "the nodelet that has the map; empty: tsdf_fusion beside this one")),
      number("publish_rate_hz", &publish_rate_hz, 0.1, 30.0, "of updates of the markers"),
      number("points_rate_hz", &points_rate_hz, 0.01, 30.0, "of the points and the blocks' boxes, at most")};
  return joined({mesh.table(), live.table(), own});
}

std::vector<std::pair<std::string, ParameterTable>> SurfaceMeshNodeletParameters::stages() {
  return {{"texturing", texturing.table()}};
}

}  // namespace depth_fusion
