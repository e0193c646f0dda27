// The nodelet surface_mesh with a map that tests change.
#pragma once

#include <algorithm>

#include "support/marker_screen.h"
#include "support/nodelet_graph.h"
#include "support/offered_map.h"

namespace depth_fusion {

inline SignedDistance twoBalls() {
  return [](const Eigen::Vector3d& p) {
    return std::min(ball({-0.06, -0.06, -0.06}, 0.03)(p), ball({0.06, 0.06, 0.06}, 0.04)(p));
  };
}

class LiveSurfaceTest : public testing::Test {
 protected:
  LiveSurfaceTest() : graph_("live_surface"), map_(graph_.resolve("tsdf_fusion"), false) {
    graph_.handle().setParam("surface_mesh/chunk_blocks", 2);
    graph_.handle().setParam("surface_mesh/triangle_share", 1.0);  // so that it can be compared with the mesh
    graph_.handle().setParam("surface_mesh/publish_rate_hz", 20.0);
    graph_.handle().setParam("surface_mesh/points_rate_hz", 20.0);
  }
  void load() { ASSERT_TRUE(graph_.load("surface_mesh")); }
  // Long enough for several updates.
  static void waitForUpdates() { ros::WallDuration(0.5).sleep(); }

  NodeletGraph graph_;
  OfferedMap map_;
};

}  // namespace depth_fusion
