// The surface as a cloud of PCL's.
#include <gtest/gtest.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include "ros/conversions/surface_messages.h"
#include "ros/conversions/surface_points.h"

namespace depth_fusion {
namespace {

TEST(Thinned, keepsTheFirstVertexOfEachCube) {
  TriangleMesh mesh;
  for (const float x : {0.001f, 0.009f, -0.001f, 0.011f, 0.002f, -0.011f, 1234.0f, 1234.004f}) {
    mesh.vertices.push_back({{x, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f}});
    mesh.colors.push_back({static_cast<uint8_t>(mesh.vertices.size()), 0, 0});
  }
  const TriangleMesh kept = thinned(mesh, 0.01f);
  std::vector<int> numbers;
  for (const MeshColor& color : kept.colors) numbers.push_back(color[0]);
  EXPECT_EQ(numbers, (std::vector<int>{1, 3, 4, 6, 7}));
  EXPECT_EQ(kept.vertices.size(), numbers.size());
  EXPECT_EQ(thinned(mesh, 0.0f).vertices.size(), mesh.vertices.size());
}

TEST(SurfacePoints, AreTheVerticesOfAllMeshes) {
  TriangleMesh colored, plain;
  for (int i = 0; i < 4; ++i) {
    colored.vertices.push_back({{0.1f * static_cast<float>(i), 0.2f, -1.0f}, Eigen::Vector3f::Unit(i % 3)});
    colored.colors.push_back({static_cast<uint8_t>(51 * i), 255, 0});
  }
  plain.vertices = colored.vertices;
  std_msgs::Header header;
  header.frame_id = "map";
  header.stamp = ros::Time(100.5);
  const auto cloud = makeSurfacePoints(header, {1.0, 2.0, 3.0}, {&colored, &plain});
  EXPECT_EQ(cloud->header.frame_id, "map");
  EXPECT_EQ(cloud->header.stamp, 100500000u);
  EXPECT_TRUE(cloud->is_dense);
  EXPECT_EQ(cloud->sensor_origin_.head<3>(), Eigen::Vector3f(1.0f, 2.0f, 3.0f));
  ASSERT_EQ(cloud->size(), 8u);
  EXPECT_EQ(cloud->width, 8u);
  EXPECT_EQ(cloud->height, 1u);
  for (size_t i = 0; i < 8; ++i) {
    const pcl::PointXYZRGBNormal& point = (*cloud)[i];
    EXPECT_EQ(point.getVector3fMap(), colored.vertices[i % 4].position_W);
    EXPECT_EQ(point.getNormalVector3fMap(), colored.vertices[i % 4].normal_W);
    const MeshColor color = shownColor(i < 4 ? colored : plain, i % 4);
    EXPECT_EQ((MeshColor{point.r, point.g, point.b}), color);
  }
  EXPECT_TRUE(makeSurfacePoints(header, {0.0, 0.0, 0.0}, {})->empty());
}

}  // namespace
}  // namespace depth_fusion
