// What viewers are shown of the surface as it changes.
#include <dynamic_reconfigure/Reconfigure.h>
#include <sensor_msgs/PointCloud2.h>

#include "support/live_surface_fixture.h"

namespace depth_fusion {
namespace {

using visualization_msgs::Marker;

TEST_F(LiveSurfaceTest, markersFollowTheSurface) {
  load();
  Screen screen(graph_.handle(), "surface_mesh/markers");
  map_.show(twoBalls());
  EXPECT_TRUE(screen.shows(map_.mesh()));
  EXPECT_EQ(screen.takeTraffic().all_deleted, 1u);  // of what an earlier publisher left
  const size_t before = screen.markers().size();
  map_.show(ball({0.06, 0.06, 0.06}, 0.041));
  EXPECT_TRUE(screen.shows(map_.mesh()));
  EXPECT_LT(screen.markers().size(), before);
  const Screen::Traffic traffic = screen.takeTraffic();
  EXPECT_EQ(traffic.deleted, before - screen.markers().size());
  EXPECT_EQ(traffic.all_deleted, 0u);
  map_.show(nothing());
  EXPECT_TRUE(screen.shows(TriangleMesh()));
  EXPECT_TRUE(screen.markers().empty());
}

TEST_F(LiveSurfaceTest, onlyWhatChangedIsPublished) {
  graph_.handle().setParam("surface_mesh/refresh_chunks", 0);
  load();
  Screen screen(graph_.handle(), "surface_mesh/markers");
  map_.show(twoBalls());
  EXPECT_TRUE(screen.shows(map_.mesh()));
  // Chunks that the viewer has already may come once more; then there is silence.
  EXPECT_TRUE(eventually([&] {
    screen.takeTraffic();
    waitForUpdates();
    return screen.takeTraffic().added == 0;
  }));
  const std::map<int, Marker> before = screen.markers();
  map_.show([](const Eigen::Vector3d& p) {
    return std::min(ball({-0.06, -0.06, -0.06}, 0.031)(p), ball({0.06, 0.06, 0.06}, 0.04)(p));
  });
  EXPECT_TRUE(screen.shows(map_.mesh()));
  EXPECT_LT(screen.takeTraffic().added, before.size());
}

TEST_F(LiveSurfaceTest, aShareOfTheTrianglesIsKept) {
  graph_.handle().setParam("surface_mesh/triangle_share", 0.5);
  graph_.handle().setParam("surface_mesh/chunk_blocks", 16);
  load();
  Screen screen(graph_.handle(), "surface_mesh/markers");
  map_.show(ball({0.0, 0.0, 0.0}, 0.08));
  const size_t all = map_.mesh().triangles.size();
  EXPECT_TRUE(eventually([&] {
    const size_t shown = screen.triangles().size();
    return shown > all / 3 && shown < 2 * all / 3;
  }));
}

TEST_F(LiveSurfaceTest, nothingIsSentWhileNothingChanges) {
  load();
  Screen screen(graph_.handle(), "surface_mesh/markers");
  Listener<sensor_msgs::PointCloud2> points(graph_.handle(), "surface_mesh/points");
  Listener<Marker> blocks(graph_.handle(), "surface_mesh/blocks");
  map_.show(twoBalls());
  EXPECT_TRUE(screen.shows(map_.mesh()));
  EXPECT_TRUE(eventually([&] {
    screen.takeTraffic();
    const size_t before = points.count() + blocks.count();
    waitForUpdates();
    return screen.takeTraffic().added == 0 && points.count() + blocks.count() == before;
  }));
}

// What does not fit the budget comes coarse or later, and in the end all of it is there.
TEST_F(LiveSurfaceTest, aSmallBudgetShowsAllOfItInTheEnd) {
  graph_.handle().setParam("surface_mesh/max_bandwidth_mb_s", 0.1);
  load();
  Screen screen(graph_.handle(), "surface_mesh/markers");
  map_.show(twoBalls());
  EXPECT_TRUE(screen.shows(map_.mesh()));
  screen.takeTraffic();
  const ros::WallTime begin = ros::WallTime::now();
  for (int i = 0; i < 10; ++i) {
    map_.show(ball({0.06, 0.06, 0.06}, 0.03 + 0.001 * i));
    waitForUpdates();
  }
  const double seconds = (ros::WallTime::now() - begin).toSec();
  // A second's worth may have been saved up, and the last message may go beyond it.
  EXPECT_LT(static_cast<double>(screen.takeTraffic().bytes), 1e5 * (seconds + 3.0));
  EXPECT_TRUE(screen.shows(map_.mesh()));
}

TEST_F(LiveSurfaceTest, resetClearsTheScreen) {
  load();
  Screen screen(graph_.handle(), "surface_mesh/markers");
  map_.show(twoBalls());
  EXPECT_TRUE(screen.shows(map_.mesh()));
  screen.takeTraffic();
  map_.reset();
  EXPECT_TRUE(screen.shows(TriangleMesh()));
  EXPECT_EQ(screen.takeTraffic().all_deleted, 1u);
  map_.show(ball({0.0, 0.0, 0.0}, 0.05));
  EXPECT_TRUE(screen.shows(map_.mesh()));
}

TEST_F(LiveSurfaceTest, anotherMapTakesTheFirstsPlace) {
  load();
  Screen screen(graph_.handle(), "surface_mesh/markers");
  map_.show(twoBalls());
  EXPECT_TRUE(screen.shows(map_.mesh()));
  OfferedMap other(graph_.resolve("tsdf_fusion"));
  other.show(ball({0.0, 0.0, 0.0}, 0.05));
  EXPECT_TRUE(screen.shows(other.mesh()));
  EXPECT_TRUE(eventually([&] { return !map_.isFollowed(); }, 30.0));
}

TEST_F(LiveSurfaceTest, parametersChangeMeanwhile) {
  load();
  Screen screen(graph_.handle(), "surface_mesh/markers");
  map_.show(twoBalls());
  EXPECT_TRUE(screen.shows(map_.mesh()));
  const size_t markers = screen.markers().size();
  dynamic_reconfigure::Reconfigure call;
  dynamic_reconfigure::IntParameter chunk_blocks;
  chunk_blocks.name = "chunk_blocks";
  chunk_blocks.value = 8;
  call.request.config.ints.push_back(chunk_blocks);
  ASSERT_TRUE(ros::service::call(graph_.resolve("surface_mesh") + "/set_parameters", call));
  EXPECT_TRUE(
      eventually([&] { return !screen.markers().empty() && screen.markers().size() < markers; }, 30.0));
  EXPECT_TRUE(screen.shows(map_.mesh()));
}

// Real frames, tracked and fused: what the screen shows in the end is the map's surface.
TEST_F(LiveSurfaceTest, fusionIsFollowed) {
  constexpr int kFrames = 15;
  NodeletGraph graph("live_fusion");
  graph.handle().setParam("surface_mesh/triangle_share", 1.0);
  graph.handle().setParam("surface_mesh/publish_rate_hz", 10.0);
  graph.handle().setParam("surface_mesh/chunks_per_update", 50);
  Listener<MapStatus> map_status(graph.handle(), "tsdf_fusion/status");
  graph.loadTracking();
  ASSERT_TRUE(graph.load("surface_mesh"));
  FakeCamera camera(graph.handle());
  ASSERT_TRUE(camera.awaitSubscribers());
  Screen screen(graph.handle(), "surface_mesh/markers");
  for (const RgbdFrame& frame : simulatedFrames(smallRoom(kFrames))) {
    camera.publish(frame);
    EXPECT_NE(map_status.awaitStamp(toRosTime(frame.stamp_s)), nullptr);
  }
  const std::shared_ptr<SharedMap> map = findMap(graph.resolve("tsdf_fusion"));
  ASSERT_NE(map, nullptr);
  TriangleMesh mesh;
  map->locked([&](FusedMap& fused) { exportSurfaceMesh(*map->compute, fused.map(), mesh); });
  EXPECT_GT(mesh.triangles.size(), 10000u);
  EXPECT_TRUE(screen.shows(mesh));
}

}  // namespace
}  // namespace depth_fusion
