#include "depth_fusion/tsdf_fusion/tsdf_fusion.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "tsdf_fusion/tsdf_fusion_kernels.h"

namespace depth_fusion {
namespace {

constexpr int kRequestCapacity = 65536;

struct Request {
  int x, y, z, unused;
};

bool byIndex(const BlockSparseMap::BlockIndex& a, const BlockSparseMap::BlockIndex& b) {
  return std::make_tuple(a.z(), a.y(), a.x()) < std::make_tuple(b.z(), b.y(), b.x());
}

// Sampling points lie at most half a block apart across the rays, at a depth of 3 m, and along them.
SelectionArgs selectionArgs(const MapParameters& map, const CameraIntrinsics& camera) {
  const float half_block_m = 0.5f * map.voxel_size_m * map.block_size;
  SelectionArgs args{};
  args.stride_px = std::clamp(static_cast<int>(half_block_m * static_cast<float>(camera.fx) / 3.0f), 1, 4);
  args.band_samples = static_cast<int>(std::ceil(2.0f * map.truncation_m / half_block_m)) + 1;
  args.capacity = kRequestCapacity;
  return args;
}

}  // namespace

ParameterTable FusionParameters::table() {
  return {{"weight_at_1m", &weight_at_1m, 0.1, 255.0, "weight of a measurement at 1 m; falls with the depth's square"},
          {"max_weight", &max_weight, 1.0, 255.0, "bound of a voxel's weight (the paper's W_max)"}};
}

TsdfFusion::TsdfFusion(ComputeContext& compute, BlockSparseMap& map, const FusionParameters& parameters)
    : compute_(compute),
      map_(map),
      parameters_(parameters),
      requests_(compute, kRequestCapacity * sizeof(Request), "block requests"),
      visible_(compute, map.usage().capacity * sizeof(int), "the list of visible blocks"),
      empty_(compute, map.usage().capacity * sizeof(int), "the list of empty blocks"),
      count_(compute, sizeof(int), "a list's length"),
      kernels_(std::make_unique<Kernels>(compute, map.parameters())) {
  validate(parameters_.table());
}

TsdfFusion::~TsdfFusion() = default;

FusionResult TsdfFusion::integrate(const DepthFrame& frame, const Pose& T_W_D, StageTimers& timers) {
  FusionResult result;
  const Pose T_D_W = T_W_D.inverse();
  {
    const StageTimers::Scope timer(timers, "tsdf_fusion/select_blocks");
    allocateBlocks(frame, T_W_D, result);
    count_.fill(0, sizeof(int));
    kernels_->listVisibleBlocks(frame, map_, visible_, count_, T_D_W);
    result.blocks_updated = count_.read<int>(1).front();
  }
  const int visible_count = static_cast<int>(result.blocks_updated);
  {
    const StageTimers::Scope timer(timers, "tsdf_fusion/integrate");
    const FusionArgs args{parameters_.weight_at_1m, 0.25f, 16.0f, parameters_.max_weight, frame_number_++};
    kernels_->integrateBlocks(frame, map_, visible_, visible_count, T_D_W, args);
    compute_.finish();
  }
  {
    const StageTimers::Scope timer(timers, "tsdf_fusion/release_blocks");
    count_.fill(0, sizeof(int));
    kernels_->listEmptyBlocks(map_, visible_, visible_count, empty_, count_);
    std::vector<int> slots = empty_.read<int>(count_.read<int>(1).front());
    std::sort(slots.begin(), slots.end());
    map_.release(slots);
    result.blocks_released = slots.size();
  }
  return result;
}

void TsdfFusion::allocateBlocks(const DepthFrame& frame, const Pose& T_W_D, FusionResult& result) {
  const SelectionArgs args = selectionArgs(map_.parameters(), frame.levels[0].camera);
  for (bool list_was_full = true; list_was_full;) {
    count_.fill(0, sizeof(int));
    kernels_->requestBlocks(frame, map_, requests_, count_, T_W_D, args);
    const int count = count_.read<int>(1).front();
    list_was_full = count > args.capacity;
    std::vector<BlockSparseMap::BlockIndex> blocks;
    for (const Request& request : requests_.read<Request>(std::min(count, args.capacity))) {
      blocks.emplace_back(request.x, request.y, request.z);
    }
    std::sort(blocks.begin(), blocks.end(), byIndex);
    const size_t allocated = map_.allocate(blocks);
    result.blocks_requested += blocks.size();
    result.blocks_allocated += allocated;
    if (allocated < blocks.size()) return;
  }
}

}  // namespace depth_fusion
