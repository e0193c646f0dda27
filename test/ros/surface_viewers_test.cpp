// Viewers of the surface that come late, stall, go, or are two.
#include <sensor_msgs/PointCloud2.h>

#include "support/live_surface_fixture.h"
#include "support/other_viewer.h"

namespace depth_fusion {
namespace {

using visualization_msgs::MarkerArray;

constexpr size_t kMoreThanSocketsKeep = 8 << 20;

class SurfaceViewersTest : public LiveSurfaceTest {};

// All the subscribers of a process are one viewer of a topic: nobody tells of the late one.
TEST_F(SurfaceViewersTest, lateViewersBesideAnotherGetAllOfIt) {
  graph_.handle().setParam("surface_mesh/refresh_chunks", 2);  // of one process, they go unnoticed
  load();
  Screen early(graph_.handle(), "surface_mesh/markers");
  map_.show(twoBalls());
  EXPECT_TRUE(early.shows(map_.mesh()));
  Screen late(graph_.handle(), "surface_mesh/markers");
  EXPECT_TRUE(late.shows(map_.mesh()));
}

// The early one looks at another topic.
TEST_F(SurfaceViewersTest, lateViewersGetAllOfIt) {
  graph_.handle().setParam("surface_mesh/refresh_chunks", 0);
  graph_.handle().setParam("surface_mesh/chunks_per_update", 2);
  load();
  Listener<sensor_msgs::PointCloud2> early(graph_.handle(), "surface_mesh/points");
  map_.show(twoBalls());
  ASSERT_NE(early.await([](const auto& c) { return c.width * c.height > 60; }, 30.0), nullptr);
  waitForUpdates();
  Screen late(graph_.handle(), "surface_mesh/markers");
  EXPECT_TRUE(late.shows(map_.mesh()));
}

TEST_F(SurfaceViewersTest, viewersThatStalledGetAllOfItInTheEnd) {
  graph_.handle().setParam("surface_mesh/max_bandwidth_mb_s", 1000.0);
  graph_.handle().setParam("surface_mesh/chunks_per_update", 4);
  load();
  Screen screen(graph_.handle(), "surface_mesh/markers", true), passed_on(graph_.handle(), "passed_on", true);
  OtherViewer viewer(graph_.resolve("surface_mesh/markers"), graph_.resolve("passed_on"));
  map_.show(twoBalls());
  ASSERT_TRUE(passed_on.shows(map_.mesh()));
  for (const SignedDistance& last : {ball({0.0, 0.0, 0.0}, 0.1), twoBalls()}) {
    viewer.stall();
    screen.takeTraffic();
    size_t bytes = 0;
    for (int i = 0; bytes < kMoreThanSocketsKeep; ++i) {
      map_.show(ball({0.0, 0.0, 0.0}, 0.09 + 0.001 * (i % 10)));
      ASSERT_TRUE(screen.shows(map_.mesh())) << "others do not wait for it";
      bytes += screen.takeTraffic().bytes;
    }
    map_.show(last);
    ASSERT_TRUE(screen.shows(map_.mesh()));
    EXPECT_TRUE(eventually([&] {
      screen.takeTraffic();
      waitForUpdates();
      return screen.takeTraffic().added == 0;
    })) << "nothing is sent in vain";
    viewer.goOn();
    EXPECT_TRUE(passed_on.shows(map_.mesh()));
  }
}

TEST_F(SurfaceViewersTest, nothingIsDoneWithoutAViewer) {
  load();
  map_.show(twoBalls());
  waitForUpdates();
  EXPECT_FALSE(map_.isFollowed());
  {
    Screen screen(graph_.handle(), "surface_mesh/markers");
    EXPECT_TRUE(screen.shows(map_.mesh()));
    EXPECT_TRUE(map_.isFollowed());
  }
  EXPECT_TRUE(eventually([&] { return !map_.isFollowed(); }, 30.0));
}

TEST_F(SurfaceViewersTest, subscribersShareOneMessage) {
  load();
  Listener<MarkerArray> one(graph_.handle(), "surface_mesh/markers"),
      other(graph_.handle(), "surface_mesh/markers");
  ASSERT_TRUE(eventually([&] { return one.connected() && other.connected(); }));
  waitForUpdates();
  const size_t seen_by_one = one.count(), seen_by_other = other.count();
  map_.show(ball({0.0, 0.0, 0.0}, 0.05));
  EXPECT_TRUE(eventually([&] {
    const auto a = one.all(), b = other.all();
    return std::find_first_of(a.begin() + seen_by_one, a.end(), b.begin() + seen_by_other, b.end()) !=
           a.end();
  }));
}

}  // namespace
}  // namespace depth_fusion
