// What viewers are shown of the surface: markers, points, boxes.
#include <dynamic_reconfigure/Reconfigure.h>
#include <sensor_msgs/PointCloud2.h>
#include <sensor_msgs/point_cloud2_iterator.h>
#include <sys/wait.h>
#include <unistd.h>

#include "support/marker_screen.h"
#include "support/nodelet_graph.h"
#include "support/offered_map.h"

namespace depth_fusion {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

SignedDistance twoBalls() {
  return [](const Eigen::Vector3d& p) {
    return std::min(ball({-0.06, -0.06, -0.06}, 0.03)(p), ball({0.06, 0.06, 0.06}, 0.04)(p));
  };
}

constexpr size_t kMoreThanSocketsKeep = 8 << 20;

// A viewer in a process of its own, which can be made to stall. It passes on whatever it gets, for its own
// queue has no end.
class OtherViewer {
 public:
  OtherViewer(const std::string& topic, const std::string& passed_on) : process_(fork()) {
    if (process_ != 0) return;
    constexpr char kScript[] = R"(
import socket, sys, rospy
class SmallSocket(socket.socket):
    def __init__(self, *args, **kwargs):
        super().__init__(*args, **kwargs)
        self.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 16)
socket.socket = SmallSocket
publisher = None
def pass_on(message):
    global publisher
    if publisher is None:
        header = message._connection_header
        raw = type('Raw', (rospy.AnyMsg,), {'_type': header['type'], '_md5sum': header['md5sum'],
                                            '_full_text': header['message_definition']})
        publisher = rospy.Publisher(sys.argv[2], raw, queue_size=10000)
        while publisher.get_num_connections() == 0:
            rospy.rostime.wallsleep(0.01)
    copy = publisher.data_class()
    copy._buff = message._buff
    publisher.publish(copy)
rospy.init_node('other_viewer', anonymous=True)
rospy.Subscriber(sys.argv[1], rospy.AnyMsg, pass_on, queue_size=None, buff_size=1 << 24)
rospy.spin()
)";
    execlp("python3", "python3", "-c", kScript, topic.c_str(), passed_on.c_str(), nullptr);
    _exit(1);
  }
  ~OtherViewer() {
    goOn();
    kill(process_, SIGTERM);
    waitpid(process_, nullptr, 0);
  }

  void stall() { kill(process_, SIGSTOP); }
  void goOn() { kill(process_, SIGCONT); }

 private:
  pid_t process_;
};

class LiveSurfaceTest : public testing::Test {
 protected:
  LiveSurfaceTest() : graph_("live_surface"), map_(graph_.resolve("tsdf_fusion"), false) {
    graph_.handle().setParam("surface_mesh/chunk_blocks", 2);
    graph_.handle().setParam("surface_mesh/publish_rate_hz", 20.0);
    graph_.handle().setParam("surface_mesh/points_rate_hz", 20.0);
  }
  void load() { ASSERT_TRUE(graph_.load("surface_mesh")); }
  // Long enough for several updates.
  static void waitForUpdates() { ros::WallDuration(0.5).sleep(); }

  NodeletGraph graph_;
  OfferedMap map_;
};

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

TEST_F(LiveSurfaceTest, newParametersShowAllOfItAnew) {
  graph_.handle().setParam("surface_mesh/point_spacing_m", 0.1);
  load();
  Listener<sensor_msgs::PointCloud2> points(graph_.handle(), "surface_mesh/points");
  map_.show(twoBalls());
  const auto sparse = points.await([](const auto& c) { return c.width * c.height > 0; }, 30.0);
  ASSERT_NE(sparse, nullptr);
  EXPECT_LT(sparse->width * sparse->height, 60u);
  dynamic_reconfigure::Reconfigure call;
  call.request.config.doubles.resize(1);
  call.request.config.doubles[0].name = "point_spacing_m";
  call.request.config.doubles[0].value = 0.01;
  ASSERT_TRUE(ros::service::call(graph_.resolve("surface_mesh/set_parameters"), call));
  EXPECT_NE(points.await([](const auto& c) { return c.width * c.height > 60; }, 30.0), nullptr);
}

// All the subscribers of a process are one viewer of a topic: nobody tells of the late one.
TEST_F(LiveSurfaceTest, lateViewersBesideAnotherGetAllOfIt) {
  graph_.handle().setParam("surface_mesh/refresh_chunks", 2);  // of one process, they go unnoticed
  load();
  Screen early(graph_.handle(), "surface_mesh/markers");
  map_.show(twoBalls());
  EXPECT_TRUE(early.shows(map_.mesh()));
  Screen late(graph_.handle(), "surface_mesh/markers");
  EXPECT_TRUE(late.shows(map_.mesh()));
}

// The early one looks at another topic.
TEST_F(LiveSurfaceTest, lateViewersGetAllOfIt) {
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

TEST_F(LiveSurfaceTest, viewersThatStalledGetAllOfItInTheEnd) {
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

TEST_F(LiveSurfaceTest, nothingIsDoneWithoutAViewer) {
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

TEST_F(LiveSurfaceTest, subscribersShareOneMessage) {
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

TEST_F(LiveSurfaceTest, pointsLieOnTheSurface) {
  load();
  map_.show(ball({0.0, 0.0, 0.0}, 0.08));
  Listener<sensor_msgs::PointCloud2> clouds(graph_.handle(), "surface_mesh/points");
  const size_t vertices = map_.mesh().vertices.size();
  // A ball of 8 cm meets about 200 cubes of 2 cm.
  const auto cloud = clouds.await([](const auto& c) { return c.width * c.height > 150; }, 30.0);
  ASSERT_NE(cloud, nullptr);
  EXPECT_EQ(cloud->header.frame_id, "map");
  const size_t points = cloud->width * cloud->height;
  EXPECT_LT(points, vertices / 8);
  sensor_msgs::PointCloud2ConstIterator<float> x(*cloud, "x"), normal(*cloud, "normal_x");
  sensor_msgs::PointCloud2ConstIterator<uint8_t> rgb(*cloud, "rgb");
  for (size_t i = 0; i < points; ++i, ++x, ++normal, ++rgb) {
    const Eigen::Vector3f p(x[0], x[1], x[2]), n(normal[0], normal[1], normal[2]);
    EXPECT_NEAR(p.norm(), 0.08f, 0.001f);
    EXPECT_GT(n.dot(p.normalized()), 0.99f);
    EXPECT_GT(rgb[0] + rgb[1] + rgb[2], 60);
  }
}

TEST_F(LiveSurfaceTest, allVerticesArePointsWithoutSpacing) {
  graph_.handle().setParam("surface_mesh/point_spacing_m", 0.0);
  graph_.handle().setParam("surface_mesh/chunk_blocks", 64);
  load();
  map_.show(ball({0.05, 0.05, 0.05}, 0.04));
  Listener<sensor_msgs::PointCloud2> clouds(graph_.handle(), "surface_mesh/points");
  const size_t vertices = map_.mesh().vertices.size();
  EXPECT_NE(clouds.await([&](const auto& c) { return c.width * c.height == vertices; }, 30.0), nullptr);
}

TEST_F(LiveSurfaceTest, boxesAreTheBlocks) {
  load();
  map_.show(ball({0.0, 0.0, 0.0}, 0.08));
  Listener<Marker> boxes(graph_.handle(), "surface_mesh/blocks");
  const size_t blocks = map_.blocks();
  const auto marker = boxes.await([&](const Marker& m) { return m.points.size() == blocks; }, 30.0);
  ASSERT_NE(marker, nullptr);
  EXPECT_EQ(marker->type, +Marker::CUBE_LIST);
  for (const geometry_msgs::Point& p : marker->points) {
    const double from_surface_m = std::abs(Eigen::Vector3d(p.x, p.y, p.z).norm() - 0.08);
    EXPECT_LT(from_surface_m, 0.02 + 0.02 * std::sqrt(3.0));  // the truncation and half a block's diagonal
  }
}

// Real frames, tracked and fused: what the screen shows in the end is the map's surface.
TEST_F(LiveSurfaceTest, fusionIsFollowed) {
  constexpr int kFrames = 15;
  NodeletGraph graph("live_fusion");
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
