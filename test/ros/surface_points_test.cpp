// The surface as points, and the blocks as boxes.
#include "ros/conversions/surface_points.h"

#include <dynamic_reconfigure/Reconfigure.h>
#include <pcl/point_types.h>
#include <pcl_ros/point_cloud.h>
#include <sensor_msgs/PointCloud2.h>
#include <sensor_msgs/point_cloud2_iterator.h>

#include "support/live_surface_fixture.h"

namespace depth_fusion {
namespace {

using visualization_msgs::Marker;

class SurfacePointsTest : public LiveSurfaceTest {};

TEST_F(SurfacePointsTest, pointsLieOnTheSurface) {
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

// Who takes clouds of PCL's in the same process is handed the cloud itself: it has what no message carries.
TEST_F(SurfacePointsTest, withinTheProcessTheCloudIsHandedOverAndNotCopied) {
  map_.seeFrom({0.5, 0.25, -1.0});
  load();
  map_.show(ball({0.0, 0.0, 0.0}, 0.08));
  std::mutex mutex;
  std::vector<boost::shared_ptr<const SurfacePoints>> clouds;
  const ros::Subscriber subscriber = graph_.handle().subscribe<SurfacePoints>(
      "surface_mesh/points", 10, [&](const boost::shared_ptr<const SurfacePoints>& cloud) {
        const std::lock_guard<std::mutex> lock(mutex);
        clouds.push_back(cloud);
      });
  ASSERT_TRUE(eventually([&] {
    const std::lock_guard<std::mutex> lock(mutex);
    return !clouds.empty() && clouds.back()->size() > 150;
  }));
  const std::lock_guard<std::mutex> lock(mutex);
  EXPECT_EQ(clouds.back()->header.frame_id, "map");
  EXPECT_EQ(clouds.back()->sensor_origin_.head<3>(), Eigen::Vector3f(0.5f, 0.25f, -1.0f));
  for (const pcl::PointXYZRGBNormal& point : *clouds.back()) {
    EXPECT_NEAR(point.getVector3fMap().norm(), 0.08f, 0.001f);
    EXPECT_GT(point.getNormalVector3fMap().dot(point.getVector3fMap().normalized()), 0.99f);
  }
}

TEST_F(SurfacePointsTest, allVerticesArePointsWithoutSpacing) {
  graph_.handle().setParam("surface_mesh/point_spacing_m", 0.0);
  graph_.handle().setParam("surface_mesh/chunk_blocks", 64);
  load();
  map_.show(ball({0.05, 0.05, 0.05}, 0.04));
  Listener<sensor_msgs::PointCloud2> clouds(graph_.handle(), "surface_mesh/points");
  const size_t vertices = map_.mesh().vertices.size();
  EXPECT_NE(clouds.await([&](const auto& c) { return c.width * c.height == vertices; }, 30.0), nullptr);
}

TEST_F(SurfacePointsTest, newParametersShowAllOfItAnew) {
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

TEST_F(SurfacePointsTest, boxesAreTheBlocks) {
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

}  // namespace
}  // namespace depth_fusion
