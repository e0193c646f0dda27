#include "tools/evaluation/block_count.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/device_frames.h"
#include "support/test_compute.h"

namespace depth_fusion {
namespace {

constexpr CameraIntrinsics kCamera{320, 240, 120.0, 120.0, 159.5, 119.5};

MapParameters mapOf(int blocks_per_axis, int block_size, float voxel_size_m) {
  MapParameters map;
  map.blocks_per_axis = blocks_per_axis;
  map.block_size = block_size;
  map.voxel_size_m = voxel_size_m;
  return map;
}

// A wall across the optical axis.
DepthFrame frameOfWall(double z, const CameraIntrinsics& camera = kCamera) {
  const cv::Mat depth(camera.height, camera.width, CV_32FC1, cv::Scalar(z));
  const cv::Mat none = cv::Mat::zeros(depth.size(), CV_32FC3);
  return frameOfDepth(compute(), camera, depth, none, none);
}

// Blocks of the window around centre_W that hold a voxel nearer to the surface than the truncation, one by
// one.
template <class Distance>
size_t blocksWithData(const MapParameters& map, const Eigen::Vector3d& centre_W, const Distance& distance) {
  const int n = map.blocks_per_axis, m = map.block_size;
  const double truncation_m = 4.0 * map.voxel_size_m;
  const Eigen::Array3d origin = (centre_W.array() / (map.voxel_size_m * m)).floor() - n / 2;
  size_t count = 0;
  for (int block = 0; block < n * n * n; ++block) {
    const Eigen::Array3d first = m * (origin + Eigen::Array3d(block % n, block / n % n, block / n / n));
    bool has_data = false;
    for (int v = 0; v < m * m * m && !has_data; ++v) {
      const Eigen::Array3d voxel = first + Eigen::Array3d(v % m, v / m % m, v / m / m);
      has_data = std::abs(distance(Eigen::Vector3d(voxel * map.voxel_size_m))) <= truncation_m;
    }
    count += has_data;
  }
  return count;
}

void expectWithin(double relative, size_t value, size_t truth) {
  EXPECT_NEAR(static_cast<double>(value), static_cast<double>(truth), relative * static_cast<double>(truth));
}

// The band, 4 cm to both sides of a wall at 1.03 m, meets two layers of blocks of 8 cm.
TEST(SelectedBlocks, OfAWallAreTwoLayers) {
  SelectedBlocks blocks(compute(), mapOf(16, 8, 0.01f), {0.0, 0.0, 1.0});
  const DepthFrame frame = frameOfWall(1.03);
  EXPECT_EQ(blocks.claimed(), 0u);
  blocks.add(frame, Pose::Identity());
  EXPECT_EQ(blocks.claimed(), 2u * 16 * 16);
  blocks.add(frame, Pose::Identity());
  EXPECT_EQ(blocks.claimed(), 2u * 16 * 16) << "a block counts once";
  Pose moved = Pose::Identity();
  moved.translation().z() = 0.24;
  blocks.add(frame, moved);
  EXPECT_EQ(blocks.claimed(), 4u * 16 * 16) << "three blocks farther";
}

class SelectedBlocksOfSize : public testing::TestWithParam<int> {};

INSTANTIATE_TEST_SUITE_P(BlockSizes, SelectedBlocksOfSize, testing::Values(4, 8, 16));

// A tilted wall, seen head-on from all along it, for rays along the wall find less of the band.
TEST_P(SelectedBlocksOfSize, KeepsThoseThatHoldAVoxelNearTheSurface) {
  const CameraIntrinsics camera{160, 120, 160.0, 160.0, 79.5, 59.5};
  const MapParameters map = mapOf(128 / GetParam(), GetParam(), 0.01f);
  const Eigen::Vector3d centre(0.1, 0.0, 1.0), normal = Eigen::Vector3d(0.35, 0.25, 0.9).normalized();
  SelectedBlocks blocks(compute(), map, centre);
  const DepthFrame frame = frameOfWall(0.8, camera);
  Pose T_W_D(Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), normal));
  for (int i = 0; i < 49; ++i) {
    const Eigen::Vector3d along = T_W_D.linear() * Eigen::Vector3d(0.3 * (i % 7 - 3), 0.3 * (i / 7 - 3), 0.0);
    T_W_D.translation() = centre + along - 0.8 * normal;
    blocks.add(frame, T_W_D);
  }
  const size_t truth =
      blocksWithData(map, centre, [&](const Eigen::Vector3d& p) { return normal.dot(p - centre); });
  ASSERT_GT(truth, 60u);
  EXPECT_GE(blocks.claimed(), truth);
  expectWithin(0.05, blocks.kept(), truth);
}

TEST(SelectedBlocks, CountsMoreThanOneListHolds) {
  const CameraIntrinsics camera{640, 480, 300.0, 300.0, 319.5, 239.5};
  SelectedBlocks blocks(compute(), mapOf(300, 4, 0.0015f), {0.0, 0.0, 1.0});
  const DepthFrame frame = frameOfWall(1.0005, camera);
  blocks.add(frame, Pose::Identity());
  const size_t columns = 300 * static_cast<size_t>(480 / 300.0 * 1.0005 / 0.006);
  EXPECT_GT(blocks.claimed(), 2 * columns);
  EXPECT_LT(blocks.claimed(), 4 * columns);
  const size_t claimed = blocks.claimed();
  ASSERT_GT(claimed, 2u * 65536);
  blocks.add(frame, Pose::Identity());
  EXPECT_EQ(blocks.claimed(), claimed);
}

// A sphere around `centre` in strips of latitude and longitude.
TriangleMesh sphereMesh(const Eigen::Vector3d& centre, double radius_m, int strips) {
  TriangleMesh mesh;
  const double step = 3.141592653589793 / strips;
  for (int i = 0; i <= strips; ++i) {
    for (int j = 0; j < 2 * strips; ++j) {
      const Eigen::Vector3d normal(std::sin(i * step) * std::cos(j * step),
                                   std::sin(i * step) * std::sin(j * step), std::cos(i * step));
      mesh.vertices.push_back({(centre + radius_m * normal).cast<float>(), normal.cast<float>()});
      const uint32_t here = i * 2 * strips + j, beside = i * 2 * strips + (j + 1) % (2 * strips);
      const uint32_t below = here + 2 * strips, below_beside = beside + 2 * strips;
      if (i < strips)
        mesh.triangles.insert(mesh.triangles.end(), {{here, below, beside}, {beside, below, below_beside}});
    }
  }
  return mesh;
}

class BlocksAroundOfSize : public testing::TestWithParam<int> {};

INSTANTIATE_TEST_SUITE_P(BlockSizes, BlocksAroundOfSize, testing::Values(4, 8, 16));

// Triangles smaller and larger than blocks.
TEST_P(BlocksAroundOfSize, ASphereAreThoseThatHoldAVoxelNearIt) {
  const Eigen::Vector3d centre(0.31, -0.22, 0.17);
  const MapParameters map = mapOf(128 / GetParam(), GetParam(), 0.01f);
  const size_t truth =
      blocksWithData(map, centre, [&](const Eigen::Vector3d& p) { return (p - centre).norm() - 0.4; });
  for (const int strips : {40, 120})
    expectWithin(0.03, blocksAround(sphereMesh(centre, 0.4, strips), map, centre), truth);
}

TEST(BlocksAround, LeavesOutWhatLiesOutsideOfTheWindow) {
  const TriangleMesh mesh = sphereMesh(Eigen::Vector3d::Zero(), 0.4, 60);
  const MapParameters map = mapOf(16, 8, 0.01f);
  EXPECT_GT(blocksAround(mesh, map, Eigen::Vector3d::Zero()), 100u);
  EXPECT_EQ(blocksAround(mesh, map, {5.0, 0.0, 0.0}), 0u);
}

}  // namespace
}  // namespace depth_fusion
