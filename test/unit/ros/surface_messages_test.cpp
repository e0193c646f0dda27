#include "ros/conversions/surface_messages.h"

#include <gtest/gtest.h>

#include "support/test_compute.h"

namespace depth_fusion {
namespace {

using visualization_msgs::Marker;

// Two triangles that share a side.
TriangleMesh kite(bool colored) {
  TriangleMesh mesh;
  for (int i = 0; i < 4; ++i) {
    mesh.vertices.push_back({{0.1f * i, 0.2f * (i % 2), -1.0f}, Eigen::Vector3f::Unit(i % 3)});
    if (colored) mesh.colors.push_back({static_cast<uint8_t>(51 * i), 255, 0});
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}};
  return mesh;
}

TEST(SurfaceMarker, listsTheCornersWithTheirColors) {
  const TriangleMesh mesh = kite(true);
  const Marker marker = makeSurfaceMarker("world", 7, mesh);
  EXPECT_EQ(marker.header.frame_id, "world");
  EXPECT_TRUE(marker.header.stamp.isZero());
  EXPECT_EQ(marker.id, 7);
  EXPECT_EQ(marker.type, +Marker::TRIANGLE_LIST);
  EXPECT_EQ(marker.action, +Marker::ADD);
  EXPECT_EQ(marker.scale.x * marker.scale.y * marker.scale.z, 1.0);
  const uint32_t corners[] = {0, 2, 1, 1, 2, 3};
  ASSERT_EQ(marker.points.size(), 6u);
  ASSERT_EQ(marker.colors.size(), 6u);
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(static_cast<float>(marker.points[i].x), mesh.vertices[corners[i]].position_W.x());
    EXPECT_EQ(static_cast<float>(marker.points[i].y), mesh.vertices[corners[i]].position_W.y());
    EXPECT_EQ(static_cast<float>(marker.points[i].z), -1.0f);
    EXPECT_FLOAT_EQ(marker.colors[i].r, 0.2f * corners[i]);
    EXPECT_FLOAT_EQ(marker.colors[i].g, 1.0f);
    EXPECT_FLOAT_EQ(marker.colors[i].b, 0.0f);
    EXPECT_FLOAT_EQ(marker.colors[i].a, 1.0f);
  }
}

// The six sides of a box must not look alike, and none is black.
TEST(SurfaceMarker, withoutColorsShowsWhichWayTheSurfaceFaces) {
  std::vector<Eigen::Vector3f> shades;
  for (int side = 0; side < 6; ++side) {
    TriangleMesh mesh = kite(false);
    for (MeshVertex& vertex : mesh.vertices)
      vertex.normal_W = (side < 3 ? 1.0f : -1.0f) * Eigen::Vector3f::Unit(side % 3);
    const std_msgs::ColorRGBA color = makeSurfaceMarker("map", 0, mesh).colors.at(0);
    shades.emplace_back(color.r, color.g, color.b);
    EXPECT_GT(shades.back().minCoeff(), 0.15f);
    for (int other = 0; other < side; ++other)
      EXPECT_GT((shades[side] - shades[other]).norm(), 0.04f) << side << " " << other;
  }
}

TEST(SurfaceMarker, deletionsNameOneOrAll) {
  EXPECT_EQ(makeDeletion("map", 3).action, +Marker::DELETE);
  EXPECT_EQ(makeDeletion("map", 3).id, 3);
  EXPECT_EQ(makeDeletion("map", 3).ns, makeSurfaceMarker("map", 3, kite(false)).ns);
  EXPECT_EQ(makeDeletionOfAll("map").action, +Marker::DELETEALL);
}

TEST(BlockMarker, hasACubeForEachBlock) {
  MapParameters parameters;
  parameters.voxel_size_m = 0.01f;
  parameters.blocks_per_axis = 16;
  parameters.pool_mib = 1;
  BlockMap map(compute(), parameters);
  EXPECT_EQ(makeBlockMarker("map", map).action, +Marker::DELETE);
  map.allocate({{0, 0, 0}, {-1, 2, 3}});
  const Marker marker = makeBlockMarker("map", map);
  EXPECT_EQ(marker.type, +Marker::CUBE_LIST);
  ASSERT_EQ(marker.points.size(), 2u);
  EXPECT_NEAR(marker.points[0].x, 0.04, 1e-6);
  EXPECT_NEAR(marker.points[1].x, -0.04, 1e-6);
  EXPECT_NEAR(marker.points[1].y, 0.2, 1e-6);
  EXPECT_NEAR(marker.points[1].z, 0.28, 1e-6);
  EXPECT_NEAR(marker.scale.x, 0.08, 0.01);
}

}  // namespace
}  // namespace depth_fusion
