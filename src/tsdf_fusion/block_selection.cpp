#include "tsdf_fusion/block_selection.h"

#include <algorithm>
#include <cmath>

#include "map/map_args.h"

namespace depth_fusion {
namespace {

constexpr int kListCapacity = 65536;  // blocks

// Sampling points lie at most half a block apart across the rays, at a depth of 3 m, and along them.
SelectionArgs selectionArgs(const MapParameters& map, const CameraIntrinsics& camera) {
  const float half_block_m = 0.5f * map.voxel_size_m * static_cast<float>(map.block_size);
  const float half_block_at_1m_px = half_block_m * static_cast<float>(camera.fx);
  SelectionArgs args{};
  args.stride_px = std::clamp(static_cast<int>(half_block_at_1m_px / 3.0f), 1, 4);
  args.dense_from_m = half_block_at_1m_px / (2.0f * static_cast<float>(args.stride_px));
  args.band_samples = static_cast<int>(std::ceil(2.0f * map.truncation_m / half_block_m)) + 1;
  args.capacity = kListCapacity;
  return args;
}

}  // namespace

BlockSelection::BlockSelection(ComputeContext& compute, TsdfFusion::Kernels& kernels)
    : kernels_(kernels),
      requests_(compute, kListCapacity * sizeof(BlockRequest), "block requests"),
      count_(compute, sizeof(int), "a list's length"),
      points_outside_(compute, sizeof(int), "the count of surface points") {}

size_t BlockSelection::select(const DepthFrame& frame, BlockMap& map, const Pose& T_W_D,
                              const std::function<bool(const std::vector<BlockIndex>&)>& take) {
  const SelectionArgs args = selectionArgs(map.parameters(), frame.levels[0].camera);
  for (bool goes_on = true; goes_on;) {
    count_.fill(0, sizeof(int));
    points_outside_.fill(0, points_outside_.bytes());
    kernels_.requestBlocks(frame, map, requests_, count_, points_outside_, T_W_D, args);
    const int count = count_.read<int>(1).front();
    std::vector<BlockIndex> blocks;
    for (const BlockRequest& request :
         requests_.read<BlockRequest>(static_cast<size_t>(std::min(count, kListCapacity))))
      blocks.emplace_back(request.x, request.y, request.z);
    std::sort(blocks.begin(), blocks.end(), before);
    goes_on = take(blocks) && count > kListCapacity;
  }
  return static_cast<size_t>(points_outside_.read<int>(1).front());
}

}  // namespace depth_fusion
