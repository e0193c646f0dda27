#include "tools/evaluation/resolution_plan.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

constexpr int kMaxBlocksPerAxis = 1280;  // of MapParameters
constexpr int kMaxPool_MiB = 2047;
constexpr double kMaxVoxelSize_m = 1.0, kMinVoxelSize_m = 1e-5;
constexpr int kBlockSizes[] = {8, 16, 4, 32};  // the fastest first
constexpr int kVoxelsPerAxis[] = {512, 768, 1024, 1536, 2048, 3072, 4096, 5000};

void validate(const PlanRequest& request) {
  check(request.box_m > 0.0, "the box's size must be positive");
  check(request.wished_voxel_m >= kMinVoxelSize_m && request.wished_voxel_m <= kMaxVoxelSize_m,
        "the wished voxel size must be between 0.00001 and 1 m");
  check(request.wished_voxel_m <= request.box_m / 8.0, "the box must be at least eight voxels wide");
  check(request.limit_bytes > 0, "the memory limit must be positive");
}

// Adds the cube of blocks that is at least `voxels` wide.
void addChoice(ResolutionPlan& plan, int block_size, double voxels) {
  PlanRow row;
  row.map = plan.request.map;
  row.map.block_size = block_size;
  row.map.blocks_per_axis = static_cast<int>(std::ceil(voxels / block_size - 1e-6));
  row.map.voxel_size_m = static_cast<float>(plan.request.box_m / voxels);
  if (row.map.blocks_per_axis > kMaxBlocksPerAxis || row.map.blocks_per_axis < 1) return;
  row.bytes = mapBytes(row.map, 0);
  plan.rows.push_back(row);
}

int speedRank(const PlanRow& row) {
  return static_cast<int>(std::find(std::begin(kBlockSizes), std::end(kBlockSizes), row.map.block_size) -
                          std::begin(kBlockSizes));
}

// Sizes that differ by rounding alone are the same.
bool isSmaller(float size_m, float than_m) { return size_m < 0.999f * than_m; }

bool isBetter(const PlanRow& a, const PlanRow& b, float wished_m) {
  const float size_a = a.map.voxel_size_m, size_b = b.map.voxel_size_m;
  const bool fine_a = !isSmaller(wished_m, size_a), fine_b = !isSmaller(wished_m, size_b);
  if (fine_a != fine_b) return fine_a;
  if (isSmaller(size_a, size_b)) return !fine_a;
  if (isSmaller(size_b, size_a)) return fine_a;
  return speedRank(a) < speedRank(b);
}

}  // namespace

ResolutionPlan resolutionChoices(const PlanRequest& request) {
  validate(request);
  ResolutionPlan plan{request, {}};
  const double wished = request.box_m / request.wished_voxel_m;
  std::vector<double> voxels_per_axis(std::begin(kVoxelsPerAxis), std::end(kVoxelsPerAxis));
  if (std::none_of(voxels_per_axis.begin(), voxels_per_axis.end(),
                   [&](double voxels) { return std::abs(voxels - wished) < 1e-3 * wished; }))
    voxels_per_axis.push_back(wished);
  std::sort(voxels_per_axis.begin(), voxels_per_axis.end());
  for (const double voxels : voxels_per_axis) {
    for (const int block_size : {4, 8, 16, 32}) addChoice(plan, block_size, voxels);
  }
  return plan;
}

void setBlocks(PlanRow& row, size_t blocks) {
  row.counted = true;
  row.blocks = blocks;
  row.bytes = mapBytes(row.map, blocks);
}

bool fits(const PlanRow& row, const PlanRequest& request) {
  return row.counted && row.bytes <= request.limit_bytes && poolMebibytes(row) <= kMaxPool_MiB;
}

PlanRow* recommended(ResolutionPlan& plan) {
  PlanRow* best = nullptr;
  for (PlanRow& row : plan.rows) {
    if (!fits(row, plan.request)) continue;
    if (best == nullptr || isBetter(row, *best, static_cast<float>(plan.request.wished_voxel_m))) best = &row;
  }
  return best;
}

int poolMebibytes(const PlanRow& row) {
  MapParameters without_color = row.map;
  without_color.color = false;
  const size_t voxel_bytes = mapBytes(without_color, row.blocks) - mapBytes(without_color, 0);
  return static_cast<int>((voxel_bytes + voxel_bytes / 4) >> 20) + 1;
}

}  // namespace depth_fusion
