// What the nodelet surface_mesh is told.
#pragma once

#include <string>

#include "depth_fusion/common/error.h"
#include "depth_fusion/surface_mesh/simplification.h"
#include "ros/output/live_surface.h"

namespace depth_fusion {

struct SurfaceMeshNodeletParameters {
  SurfaceMeshParameters mesh;
  LiveSurfaceParameters live;
  std::string map;  // the nodelet's resolved name
  float publish_rate_hz = 2.0f;
  float points_rate_hz = 1.0f;

  ParameterTable table() {
    ParameterTable rows = mesh.table();
    for (const Parameter& row : live.table()) rows.push_back(row);
    rows.push_back(
        atStartOnly(text("map", &map, "the nodelet that has the map; empty: tsdf_fusion beside this one")));
    rows.push_back(number("publish_rate_hz", &publish_rate_hz, 0.1, 30.0, "of updates of the markers"));
    rows.push_back(number("points_rate_hz", &points_rate_hz, 0.01, 30.0,
                          "of the points and the blocks' boxes, at most"));
    return rows;
  }

  // Throws Error for what this build cannot do.
  void checkTogether() const {
    check(live.triangle_share == 1.0f || canSimplify(),
          "triangle_share must be 1: this depth_fusion was built without meshoptimizer, which simplifies "
          "meshes");
  }
};

}  // namespace depth_fusion
