#include "tools/evaluation/resolution_plan.h"

#include <gtest/gtest.h>

#include "support/expect_error.h"
#include "tools/plots/memory_plot.h"

namespace depth_fusion {
namespace {

PlanRequest requestOf(double box_m, double voxel_m, size_t limit_mib) {
  PlanRequest request;
  request.box_m = box_m;
  request.wished_voxel_m = voxel_m;
  request.limit_bytes = limit_mib << 20;
  return request;
}

// The plan as it were if a wall of 10 m^2 were mapped.
ResolutionPlan wallPlan(const PlanRequest& request) {
  ResolutionPlan plan = resolutionChoices(request);
  for (PlanRow& row : plan.rows) {
    if (row.bytes > request.limit_bytes) continue;
    const double block_m = row.map.voxel_size_m * row.map.block_size;
    setBlocks(row, static_cast<size_t>(10.0 / (block_m * block_m) * (1.0 + 8.0 / row.map.block_size)));
  }
  return plan;
}

TEST(ResolutionPlan, EveryChoiceCoversTheBox) {
  const ResolutionPlan plan = resolutionChoices(requestOf(4.0, 0.003, 1536));
  EXPECT_GT(plan.rows.size(), 20u);
  size_t wished = 0;
  for (const PlanRow& row : plan.rows) {
    const int voxels = row.map.blocks_per_axis * row.map.block_size;
    EXPECT_GE(voxels * row.map.voxel_size_m, 4.0 - 1e-4);
    EXPECT_LT((voxels - row.map.block_size) * row.map.voxel_size_m, 4.0);
    wished += std::abs(row.map.voxel_size_m - 0.003f) < 1e-6f;
  }
  EXPECT_EQ(wished, 4u);
}

TEST(ResolutionPlan, BytesAreThoseOfTheMap) {
  ResolutionPlan plan = resolutionChoices(requestOf(4.0, 0.005, 1536));
  PlanRow& row = plan.rows.front();
  const size_t n = row.map.blocks_per_axis, m = row.map.block_size;
  EXPECT_EQ(row.bytes, 4 * n * n * n);
  EXPECT_FALSE(fits(row, plan.request)) << "not counted";
  setBlocks(row, 1000);
  EXPECT_EQ(row.bytes, 2 * 1000 * m * m * m + 4 * n * n * n);
  row.map.color = true;
  setBlocks(row, 1000);
  EXPECT_EQ(row.bytes, 6 * 1000 * m * m * m + 4 * n * n * n);
}

TEST(ResolutionPlan, RecommendsTheWishedVoxelsWhereTheyFit) {
  ResolutionPlan plan = wallPlan(requestOf(4.0, 0.005, 1536));
  const PlanRow* best = recommended(plan);
  ASSERT_NE(best, nullptr);
  EXPECT_FLOAT_EQ(best->map.voxel_size_m, 0.005f);
  EXPECT_EQ(best->map.block_size, 8);
  EXPECT_EQ(best->map.blocks_per_axis, 100);
}

TEST(ResolutionPlan, RecommendsTheFinestVoxelsWhereTheWishedDoNotFit) {
  const PlanRequest request = requestOf(4.0, 0.0008, 100);
  ResolutionPlan plan = wallPlan(request);
  const PlanRow* best = recommended(plan);
  ASSERT_NE(best, nullptr);
  EXPECT_LE(best->bytes, request.limit_bytes);
  EXPECT_GT(best->map.voxel_size_m, 0.0008f);
  for (const PlanRow& row : plan.rows) {
    if (fits(row, request)) {
      EXPECT_GE(row.map.voxel_size_m, best->map.voxel_size_m);
    }
  }
}

TEST(ResolutionPlan, RecommendsNothingWhereNothingFits) {
  ResolutionPlan plan = wallPlan(requestOf(4.0, 0.005, 1));
  EXPECT_EQ(recommended(plan), nullptr);
}

TEST(ResolutionPlan, PoolHoldsTheBlocksWithRoomToSpare) {
  ResolutionPlan plan = resolutionChoices(requestOf(4.0, 0.005, 1536));
  PlanRow& row = plan.rows.front();
  setBlocks(row, 1000000);
  const double voxel_mib =
      2.0 * 1e6 * row.map.block_size * row.map.block_size * row.map.block_size / (1 << 20);
  EXPECT_GE(poolMebibytes(row), 1.2 * voxel_mib);
  EXPECT_LE(poolMebibytes(row), 1.3 * voxel_mib + 1.0);
}

TEST(ResolutionPlan, RefusesWhatNoMapCanBe) {
  expectError([] { resolutionChoices(requestOf(0.0, 0.005, 1536)); }, {"box"});
  expectError([] { resolutionChoices(requestOf(4.0, 0.0, 1536)); }, {"voxel size"});
  expectError([] { resolutionChoices(requestOf(0.01, 0.005, 1536)); }, {"eight voxels"});
  expectError([] { resolutionChoices(requestOf(4.0, 0.005, 0)); }, {"limit"});
}

// Pixels of the colour, in the area of the bars.
int redPixels(const cv::Mat& picture) {
  cv::Mat red;
  cv::inRange(picture.rowRange(70, 380), cv::Scalar(40, 40, 210), cv::Scalar(40, 40, 210), red);
  return cv::countNonZero(red);
}

TEST(MemoryPlot, BarsOverTheLimitAreRed) {
  const cv::Mat roomy = plotMemory(wallPlan(requestOf(4.0, 0.005, 100000)));
  const cv::Mat tight = plotMemory(wallPlan(requestOf(4.0, 0.005, 60)));
  EXPECT_EQ(roomy.size(), tight.size());
  EXPECT_GT(redPixels(tight), redPixels(roomy) + 10000);
}

}  // namespace
}  // namespace depth_fusion
