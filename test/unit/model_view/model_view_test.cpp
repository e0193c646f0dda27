#include "reference/model_view.h"

#include <gtest/gtest.h>

#include <limits>
#include <opencv2/imgproc.hpp>

#include "depth_fusion/model_view/model_view_renderer.h"
#include "model_view/model_view_kernels.h"
#include "reference/depth_preprocessing.h"
#include "support/rendered_views.h"

namespace depth_fusion {
namespace {

void expectSphere(const Images& view, const Pose& T_W_D, double voxel_size_m) {
  const ViewErrors errors = compareWithSphere(view, T_W_D, voxel_size_m);
  EXPECT_GT(errors.hits, 300u);
  EXPECT_EQ(errors.missing, 0u);
  EXPECT_EQ(errors.false_hits, 0u);
  EXPECT_LT(errors.mean_vox, 0.03);
  EXPECT_LT(errors.largest_vox, 0.2);
  EXPECT_LT(errors.largest_angle_rad, 0.09);  // from 8 bits
}

class ModelViewOfBlockSize : public testing::TestWithParam<int> {};

INSTANTIATE_TEST_SUITE_P(BlockSizes, ModelViewOfBlockSize, testing::Values(4, 8, 16, 32));

TEST_P(ModelViewOfBlockSize, ShowsASphereFromInsideAndOutsideOfTheWindow) {
  const auto map = makeMap(mapParameters(GetParam()), sphereDistance);
  for (const double from_m : {0.55, 1.3}) {  // the window ends at 0.64
    for (const Eigen::Vector3d& side : {Eigen::Vector3d(0.1, 0, -1), {-0.6, 0.7, 0.4}, {0, 1, 0}}) {
      const Pose T_W_D = lookingAt(kCentre, from_m * side.normalized(), 0.4);
      expectSphere(render(*map, T_W_D), T_W_D, 0.01);
    }
  }
}

TEST_P(ModelViewOfBlockSize, ShowsATiltedPlane) {
  const Eigen::Vector3d normal = Eigen::Vector3d(0.3, -0.2, -1.0).normalized();
  const double offset_m = -0.1234;
  const auto map =
      makeMap(mapParameters(GetParam()), [&](const Eigen::Vector3d& p) { return normal.dot(p) - offset_m; });
  Pose T_W_D = Pose::Identity();
  T_W_D.translation() = Eigen::Vector3d(0.02, 0.01, -0.5);
  const Images view = render(*map, T_W_D);
  for (int y = 0; y < kCamera.height; ++y) {
    for (int x = 0; x < kCamera.width; ++x) {
      const Eigen::Vector3d ray = rayThrough(x, y);
      const double truth_m = (offset_m - normal.dot(T_W_D.translation())) / normal.dot(ray);
      ASSERT_NEAR(view.depth.at<float>(y, x), truth_m, 0.0005) << x << " " << y;
      const cv::Vec3f n = view.normals.at<cv::Vec3f>(y, x);
      ASSERT_NEAR((Eigen::Vector3d(n[0], n[1], n[2]) - normal).norm(), 0.0, 0.06) << x << " " << y;
    }
  }
}

// Hills, some behind others, with gaps where blocks are missing.
double hillDistance(const Eigen::Vector3d& p) {
  const double height = 0.12 * std::sin(9.0 * p.x()) * std::cos(8.0 * p.y()) + 0.1;
  return 0.55 * (height - p.z());
}

TEST_P(ModelViewOfBlockSize, EqualsThePlainRayCaster) {
  const SignedDistance with_gaps = [](const Eigen::Vector3d& p) {
    const bool gap = std::sin(20.0 * p.x()) > 0.8 || std::cos(17.0 * p.y() + 1.0) > 0.9;
    return gap ? 10.0 : hillDistance(p);
  };
  const auto map = makeMap(mapParameters(GetParam()), with_gaps, Eigen::Vector3d(0.05, -0.03, 0.02));
  const Pose T_W_D = lookingAt(Eigen::Vector3d(0.1, 0.0, 0.1), Eigen::Vector3d(-0.3, -0.25, -0.35), 0.3);
  const Images view = render(*map, T_W_D);
  const reference::RayCaster caster(*map);
  cv::Mat expected(view.depth.size(), CV_32FC1);
  reference::forEachPixel<float>(expected, [&](int x, int y, float& depth) {
    depth = static_cast<float>(caster.cast(T_W_D, rayThrough(x, y), kMinRange_m, 2.0));
  });
  // Rays that graze an edge or a gap may end otherwise: count those whose neighbours all hit alike, or all
  // nothing.
  cv::Mat least, most;
  cv::erode(expected, least, cv::Mat());
  cv::dilate(expected, most, cv::Mat());
  int hits = 0, wrong_hits = 0, misses = 0, false_hits = 0;
  reference::forEachPixel<float>(expected, [&](int x, int y, float depth) {
    const bool hit = least.at<float>(y, x) > 0.0f && most.at<float>(y, x) < least.at<float>(y, x) + 0.05f;
    const bool miss = most.at<float>(y, x) == 0.0f;
    hits += hit;
    misses += miss;
    wrong_hits += hit && std::abs(view.depth.at<float>(y, x) - depth) > 0.002f;
    false_hits += miss && view.depth.at<float>(y, x) > 0.0f;
  });
  EXPECT_GT(hits, 1500);
  EXPECT_GT(misses, 1000);
  EXPECT_LT(wrong_hits, hits / 50) << "of " << hits;
  EXPECT_LT(false_hits, misses / 40) << "of " << misses;
}

TEST(ModelView, WindowMayStandAnywhere) {
  for (const Eigen::Vector3d& shift : {Eigen::Vector3d(0, 0, 0), {0.31, -0.17, 0.24}, {-0.3, 0.25, -0.11}}) {
    const auto map = makeMap(mapParameters(8, 19), sphereDistance, shift);
    const Pose T_W_D = lookingAt(kCentre, Eigen::Vector3d(-0.6, 0.2, -0.9), 0.0);
    const Images view = render(*map, T_W_D);
    expectSphere(view, T_W_D, 0.01);
  }
}

TEST(ModelView, ShowsNothingBeyondItsRangeNorBehindTheCamera) {
  expectNothingOutOfRange(
      [](BlockMap& map, const Pose& T_W_D, float range_m) { return render(map, T_W_D, range_m); });
}

TEST(ModelView, ShowsNoSurfaceFromBehind) {
  const auto map = makeMap(mapParameters(8), sphereDistance);
  const Images view = render(*map, lookingAt(kCentre + Eigen::Vector3d::UnitX(), kCentre, 0.0));
  EXPECT_EQ(cv::countNonZero(view.depth), 0);
}

TEST(ModelView, EmptyMapShowsNothing) {
  BlockMap map(compute(), mapParameters(8));
  EXPECT_EQ(cv::countNonZero(render(map, Pose::Identity()).depth), 0);
}

TEST_P(ModelViewOfBlockSize, BlockRangesHoldEveryHit) {
  const auto map = makeMap(mapParameters(GetParam()), hillDistance);
  ModelView view;
  view.camera = kCamera;
  const int tile = RANGE_TILE;
  const int columns = (kCamera.width + tile - 1) / tile;
  const size_t tiles = columns * ((kCamera.height + tile - 1) / tile);
  const RayRangeArgs range = {kMinRange_m, kMaxRange_m, DEPTH_BINS / (kMaxRange_m - kMinRange_m)};
  ModelViewRenderer::Kernels kernels(compute(), *map);
  const reference::RayCaster caster(*map);
  for (const double roll_rad : {0.0, 0.7}) {
    view.T_W_D = lookingAt(Eigen::Vector3d(0.1, 0.0, 0.1), Eigen::Vector3d(-0.4, -0.35, -0.4), roll_rad);
    DeviceBuffer nearest(compute(), tiles * sizeof(float), "ranges"),
        occupied(compute(), tiles * DEPTH_BINS / 8, "ranges");
    nearest.write(std::vector<float>(tiles, std::numeric_limits<float>::max()));
    occupied.fill(0, occupied.bytes());
    kernels.splatBlockRanges(*map, nearest, occupied, view, range);
    const std::vector<float> start = nearest.read<float>(tiles);
    const std::vector<uint64_t> bins = occupied.read<uint64_t>(tiles);
    int hits = 0;
    for (int y = 0; y < kCamera.height; y += 3) {
      for (int x = 0; x < kCamera.width; x += 3) {
        const double depth = caster.cast(view.T_W_D, rayThrough(x, y), kMinRange_m, 2.0);
        if (depth == 0.0) continue;
        ++hits;
        const int i = y / tile * columns + x / tile;
        ASSERT_LE(start[i], depth + 1e-5) << x << " " << y;
        const int bin = static_cast<int>((depth - range.min_m) * range.bins_per_m);
        ASSERT_TRUE(bins[i] >> bin & 1) << x << " " << y;
      }
    }
    EXPECT_GT(hits, 400);
  }
}

}  // namespace
}  // namespace depth_fusion
