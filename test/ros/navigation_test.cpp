// What planners are given of a live map: each topic and service, taken as costmap_2d and the users of
// voxblox, map_server and octomap_server take them.
#include <depth_fusion/GetDistances.h>
#include <depth_fusion/SaveGrid.h>
#include <depth_fusion/SaveOctomap.h>
#include <map_msgs/OccupancyGridUpdate.h>
#include <nav_msgs/GetMap.h>
#include <sensor_msgs/LaserScan.h>
#include <sensor_msgs/point_cloud2_iterator.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <filesystem>

#include "depth_fusion/esdf/octree_file.h"
#include "support/navigation_fixture.h"
#include "support/temporary_folder.h"

namespace depth_fusion {
namespace {

using sensor_msgs::PointCloud2;

size_t pointsOf(const PointCloud2& cloud) { return static_cast<size_t>(cloud.width) * cloud.height; }

// A frame that lies in the map's as a robot's.
void sendFrame(tf2_ros::StaticTransformBroadcaster& tf, const std::string& name, const Pose& T_W_F) {
  tf.sendTransform(makeTransform(makeHeader(ros::Time::now(), "map"), name, T_W_F));
}

Pose turnedPose() {
  Pose T_W_F = Pose::Identity();
  T_W_F.linear() = Eigen::AngleAxisd(0.5 * M_PI, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T_W_F.translation() = Eigen::Vector3d(0.3, -0.2, 0.2);
  return T_W_F;
}

TEST_F(NavigationTest, WithoutViewersNothingIsDone) {
  graph_.handle().setParam("navigation/keep_s", 0.0);
  load();
  lookAround(4);
  EXPECT_FALSE(isFollowed());
  {
    const Listener<PointCloud2> clouds(graph_.handle(), "navigation/esdf_pointcloud");
    EXPECT_TRUE(eventually([&] { return isFollowed(); }));
  }
  EXPECT_TRUE(eventually([&] { return !isFollowed(); }));
}

TEST_F(NavigationTest, DistancesAreThoseOfTheRoom) {
  load();
  const Listener<PointCloud2> clouds(graph_.handle(), "navigation/esdf_pointcloud");
  const Listener<PointCloud2> slices(graph_.handle(), "navigation/esdf_slice");
  const Listener<PointCloud2> centres(graph_.handle(), "navigation/octomap_point_cloud_centers");
  ASSERT_TRUE(eventually([&] { return isFollowed(); }));
  lookAround(48);
  const auto cloud = clouds.await([](const PointCloud2& c) { return pointsOf(c) > 100000; });
  ASSERT_NE(cloud, nullptr);
  EXPECT_EQ(cloud->header.frame_id, "map");
  double sum = 0.0;
  sensor_msgs::PointCloud2ConstIterator<float> x(*cloud, "x"), intensity(*cloud, "intensity");
  for (; x != x.end(); ++x, ++intensity)
    sum += std::abs(*intensity - std::min(2.0, scene_.distance({x[0], x[1], x[2]})));
  EXPECT_LT(sum / static_cast<double>(pointsOf(*cloud)), 0.025);
  const auto slice = slices.await([](const PointCloud2& c) { return pointsOf(c) > 2500; });
  ASSERT_NE(slice, nullptr);
  for (sensor_msgs::PointCloud2ConstIterator<float> z(*slice, "z"); z != z.end(); ++z)
    EXPECT_NEAR(*z, 0.525f, 1e-4f);
  const auto occupied = centres.await([](const PointCloud2& c) { return pointsOf(c) > 10000; });
  ASSERT_NE(occupied, nullptr);
  for (sensor_msgs::PointCloud2ConstIterator<float> p(*occupied, "x"); p != p.end(); ++p)
    EXPECT_LT(std::abs(scene_.distance({p[0], p[1], p[2]})), 0.1);
}

TEST_F(NavigationTest, DistancesAreAnsweredInAnyFrame) {
  load();
  GetDistances asked;
  asked.request.points.resize(1);
  ASSERT_TRUE(call("get_distances", asked));  // from here on the map is followed
  EXPECT_TRUE(asked.response.success) << asked.response.message;
  EXPECT_FALSE(asked.response.known.front());
  EXPECT_TRUE(std::isnan(asked.response.distances.front()));
  lookAround(48);
  tf2_ros::StaticTransformBroadcaster tf;
  sendFrame(tf, "robot", turnedPose());
  asked.request.header.frame_id = "robot";
  asked.request.points.clear();
  for (int i = 0; i < 10000; ++i) {
    asked.request.points.emplace_back();
    asked.request.points.back().x = 0.008 * (i % 100) - 0.4;
    asked.request.points.back().y = 0.008 * (i / 100) - 0.4;
  }
  ASSERT_TRUE(call("get_distances", asked));
  ASSERT_TRUE(asked.response.success) << asked.response.message;
  ASSERT_EQ(asked.response.distances.size(), 10000u);
  size_t known = 0;
  for (size_t i = 0; i < 10000; ++i) {
    if (!asked.response.known[i]) continue;
    ++known;
    const auto& p = asked.request.points[i];
    const double exact_m = scene_.distance(turnedPose() * Eigen::Vector3d(p.x, p.y, p.z));
    EXPECT_NEAR(asked.response.distances[i], exact_m, 0.05);
    EXPECT_GT(asked.response.gradients[i].z, 0.5);  // the floor is nearest
  }
  EXPECT_GT(known, 9000u);
  asked.request.header.frame_id = "nowhere";
  ASSERT_TRUE(call("get_distances", asked));
  EXPECT_FALSE(asked.response.success);
  EXPECT_NE(asked.response.message.find("nowhere"), std::string::npos) << asked.response.message;
}

TEST_F(NavigationTest, TheGridIsKeptUpToDateByUpdates) {
  load();
  const Listener<nav_msgs::OccupancyGrid> maps(graph_.handle(), "navigation/map");
  const Listener<map_msgs::OccupancyGridUpdate> updates(graph_.handle(), "navigation/map_updates");
  ASSERT_TRUE(eventually([&] { return isFollowed(); }));
  lookAround(48);
  nav_msgs::GetMap asked;
  ASSERT_TRUE(call("static_map", asked));
  const nav_msgs::OccupancyGrid& now = asked.response.map;
  EXPECT_NEAR(now.info.resolution, 0.05, 1e-6);
  size_t counts[3] = {};
  for (const int8_t cell : now.data) {
    ASSERT_TRUE(cell == -1 || cell == 0 || cell == 100) << +cell;
    ++counts[cell == 100 ? 2 : cell + 1];
  }
  EXPECT_GT(counts[1], 2500u);  // of 3,584 in the room
  EXPECT_GT(counts[2], 150u);
  EXPECT_EQ(maps.all().front()->header.frame_id, "map");
  EXPECT_TRUE(eventually([&] {
    nav_msgs::OccupancyGrid patched;  // as costmap_2d's static layer does it, stamps aside
    const auto all = maps.all();
    patched = *all.back();
    for (const auto& update : updates.all()) {
      if (update->header.stamp <= patched.header.stamp) continue;
      for (uint32_t i = 0; i < update->data.size(); ++i)
        patched.data.at((update->y + i / update->width) * patched.info.width + update->x +
                        i % update->width) = update->data[i];
    }
    return patched.data == now.data;
  }));
  EXPECT_GT(updates.count(), 0u);
  const Listener<nav_msgs::OccupancyGrid> late(graph_.handle(), "navigation/map");
  EXPECT_TRUE(late.awaitCount(1));
}

TEST_F(NavigationTest, FilesAreWritten) {
  load();
  SaveGrid grid;
  SaveOctomap octomap;
  const TemporaryFolder folder;
  grid.request.path = folder / "floor";
  octomap.request.path = folder / "space.bt";
  ASSERT_TRUE(call("save_grid", grid));
  EXPECT_FALSE(grid.response.success);
  EXPECT_NE(grid.response.message.find("nothing is known"), std::string::npos) << grid.response.message;
  lookAround(12);
  ASSERT_TRUE(call("save_grid", grid));
  EXPECT_TRUE(grid.response.success) << grid.response.message;
  EXPECT_EQ(grid.response.message, folder / "floor.yaml");
  EXPECT_TRUE(std::filesystem::exists(folder / "floor.pgm"));
  ASSERT_TRUE(call("save_octomap", octomap));
  ASSERT_EQ(octomap.response.success, hasOctrees()) << octomap.response.message;
  if (!hasOctrees()) return;
  EXPECT_GT(octomap.response.free, 1000u);
  EXPECT_GT(octomap.response.occupied, 1000u);
  EXPECT_EQ(octomap.response.bytes, std::filesystem::file_size(folder / "space.bt"));
  octomap.request.path = "";
  ASSERT_TRUE(call("save_octomap", octomap));
  EXPECT_FALSE(octomap.response.success);
}

TEST_F(NavigationTest, ScansMarkAndClear) {
  graph_.handle().setParam("navigation/scan_frame", "base");
  graph_.handle().setParam("navigation/scan_range_m", 1.2);
  load();
  tf2_ros::StaticTransformBroadcaster tf;
  sendFrame(tf, "base", turnedPose());
  const Listener<sensor_msgs::LaserScan> scans(graph_.handle(), "navigation/scan");
  const Listener<PointCloud2> clouds(graph_.handle(), "navigation/obstacles");
  ASSERT_TRUE(eventually([&] { return isFollowed(); }));
  lookAround(48);
  const auto known = [](const sensor_msgs::LaserScan& s) {
    return std::count_if(s.ranges.begin(), s.ranges.end(), [](float r) { return !std::isnan(r); }) > 600;
  };
  const auto scan = scans.await(known);
  ASSERT_NE(scan, nullptr);
  EXPECT_EQ(scan->header.frame_id, "base");
  size_t hits = 0, clear = 0;
  for (size_t i = 0; i < scan->ranges.size(); ++i) {
    const double angle = scan->angle_min + static_cast<double>(i) * scan->angle_increment;
    const Eigen::Vector3d ray =
        turnedPose().linear() * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0);
    const Eigen::Vector3d eye = turnedPose().translation();
    clear += std::isinf(scan->ranges[i]);
    if (!std::isfinite(scan->ranges[i])) continue;
    ++hits;
    const Eigen::Vector3d end = eye + scan->ranges[i] * ray;
    double nearest_m = 1.0;  // of what is in the way, at any height
    for (double z = 0.1; z < 1.8; z += 0.05)
      nearest_m = std::min(nearest_m, scene_.distance({end.x(), end.y(), z}));
    EXPECT_LT(nearest_m, 0.1);
  }
  EXPECT_GT(hits, 50u);
  EXPECT_GT(clear, 50u);
  const auto cloud = clouds.await([](const PointCloud2& c) { return pointsOf(c) > 50; });
  ASSERT_NE(cloud, nullptr);
  EXPECT_EQ(cloud->header.frame_id, "base");
  for (sensor_msgs::PointCloud2ConstIterator<float> p(*cloud, "x"); p != p.end(); ++p)
    EXPECT_LT(std::hypot(p[0], p[1]), 1.21f);
}

}  // namespace
}  // namespace depth_fusion
