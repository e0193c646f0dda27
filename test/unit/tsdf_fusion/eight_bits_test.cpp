// Voxels of bytes against voxels of floats: long runs at small gains, where rounding to the nearest byte
// would stall.
#include <gtest/gtest.h>

#include "support/fusion_views.h"

namespace depth_fusion {
namespace {

constexpr int kFrames = 1000;
constexpr double kMaxBias_vox = 0.02;

struct TracedVoxel {
  BlockIndex block;
  int number;
  Voxel exact, nearest;
};

// Voxels before and behind a wall at 1 m, some of each block.
std::vector<TracedVoxel> voxelsToTrace(const BlockMap& map) {
  const int m = map.parameters().block_size;
  std::vector<TracedVoxel> voxels;
  for (const SlotTable::Block& block : map.slots().blocks()) {
    for (int i = 0; i < m * m * m; i += 29) {
      if (std::abs(voxelOf(block.index, i, m).z() * map.parameters().voxel_size_m - 1.0) < 0.011) {
        voxels.push_back({block.index, i, {}, {}});
      }
    }
  }
  return voxels;
}

View wallWithNoise(double z_m, double sigma_m, cv::RNG& random) {
  static const cv::Mat normals(kCamera.height, kCamera.width, CV_32FC3, cv::Scalar(0.0, 0.0, -1.0));
  cv::Mat depth = wallDepth(z_m);
  reference::forEachPixel<float>(depth, [&](int, int, float& pixel) { pixel += random.gaussian(sigma_m); });
  const cv::Mat measured = reference::measurements(depth, normals, cv::Mat(), kCamera);
  return {kCamera, Pose::Identity(), depth, normals, quantised(measured)};
}

struct Bias {
  double bytes_vox = 0.0, nearest_vox = 0.0, spread_vox = 0.0;
  size_t voxels = 0;
};

Bias biasOf(const std::vector<TracedVoxel>& voxels, const MapContent& content, double steps_per_voxel) {
  Bias bias;
  double squares = 0.0;
  for (const TracedVoxel& voxel : voxels) {
    const auto block = content.find(keyOf(voxel.block));
    if (!voxel.exact.known || block == content.end()) continue;
    const Voxel fused = voxelOf(block->second, voxel.number);
    EXPECT_TRUE(fused.known);
    const double error_vox = (fused.steps - voxel.exact.steps) / steps_per_voxel;
    bias.bytes_vox += error_vox;
    squares += error_vox * error_vox;
    bias.nearest_vox += (voxel.nearest.steps - voxel.exact.steps) / steps_per_voxel;
    ++bias.voxels;
  }
  const double count = static_cast<double>(bias.voxels);
  bias.bytes_vox /= count;
  bias.nearest_vox /= count;
  bias.spread_vox = std::sqrt(squares / count);
  return bias;
}

// A wall that stands at 1 m until the filter has settled, then jumps by 4 mm.
Bias runOf(const TsdfFusionParameters& fusion_parameters) {
  MapParameters parameters = mapParameters(8, 32, 0.01f);
  parameters.truncation_m = 0.04f;
  BlockMap map(compute(), parameters);
  TsdfFusion fusion(compute(), map, fusion_parameters);
  cv::RNG random(4);
  integrate(fusion, wallWithNoise(1.0, 0.0, random));
  std::vector<TracedVoxel> voxels = voxelsToTrace(map);
  map.reset(Eigen::Vector3d::Zero());
  for (int frame = 0; frame < kFrames; ++frame) {
    const View view = wallWithNoise(frame < 200 ? 1.0 : 1.004, 0.0015, random);
    integrate(fusion, view);
    for (TracedVoxel& voxel : voxels) {
      const Measurement measured = measure(view, Pose::Identity(), parameters, fusion_parameters, voxel.block,
                                           voxelOf(voxel.block, voxel.number, parameters.block_size));
      voxel.exact = fuse(voxel.exact, measured, fusion_parameters);
      voxel.nearest = roundedToNearest(fuse(voxel.nearest, measured, fusion_parameters));
    }
  }
  const double steps_per_voxel = TSDF_MAX * parameters.voxel_size_m / parameters.truncation_m;
  return biasOf(voxels, readMap(map), steps_per_voxel);
}

void expectNoStall(const TsdfFusionParameters& parameters) {
  const Bias bias = runOf(parameters);
  std::printf("bytes against floats: bias %.4f, spread %.3f; to the nearest: bias %.3f voxels\n",
              bias.bytes_vox, bias.spread_vox, bias.nearest_vox);
  ASSERT_GT(bias.voxels, 200u);
  EXPECT_NEAR(bias.bytes_vox, 0.0, kMaxBias_vox);
  EXPECT_GT(std::abs(bias.nearest_vox), kMaxBias_vox) << "the control: rounding to the nearest fails";
}

TEST(EightBits, weighted_at_100) {
  TsdfFusionParameters parameters;
  parameters.rule = "weighted";
  parameters.weight_at_1m = 1.0f;
  parameters.max_weight = 100.0f;
  expectNoStall(parameters);
}

TEST(EightBits, average_at_gain_0_005) {
  TsdfFusionParameters parameters;
  parameters.rule = "average";
  parameters.gain_at_1m = 0.005f;
  expectNoStall(parameters);
}

// A settled Kalman filter's gain is the process sigma over the sensor's, 1.9 mm at 1 m.
TEST(EightBits, kalman_at_gain_0_02) {
  TsdfFusionParameters parameters;
  parameters.process_sigma_m = 0.02f * 0.00188f;
  expectNoStall(parameters);
}

TEST(EightBits, kalman_at_gain_0_005) {
  TsdfFusionParameters parameters;
  parameters.process_sigma_m = 0.005f * 0.00188f;
  expectNoStall(parameters);
}

}  // namespace
}  // namespace depth_fusion
