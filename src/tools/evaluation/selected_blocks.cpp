#include <algorithm>
#include <cmath>

#include "tools/evaluation/block_count.h"
#include "map/map_args.h"
#include "tsdf_fusion/tsdf_fusion_kernels.h"

namespace depth_fusion {
namespace {

constexpr int kCapacity = 65536;  // claims a launch

// The mean of |n_x| + |n_y| + |n_z| over all unit normals is the mean extent of a cube of edge 1 along them.
constexpr double kMeanCubeExtent = 1.5;

MapParameters withSmallestPool(MapParameters map) {
  map.pool_mib = 1;
  map.color = false;
  return map;
}

}  // namespace

struct SelectedBlocks::Selection {
  BlockSparseMap map;
  DeviceBuffer requests, count, points_outside;
  TsdfFusion::Kernels kernels;

  Selection(ComputeContext& compute, const MapParameters& parameters)
      : map(compute, withSmallestPool(parameters)),
        requests(compute, kCapacity * sizeof(BlockRequest), "block requests"),
        count(compute, sizeof(int), "a list's length"),
        points_outside(compute, sizeof(int), "the count of surface points"),
        kernels(compute, map) {}
};

SelectedBlocks::SelectedBlocks(ComputeContext& compute, const MapParameters& map,
                               const Eigen::Vector3d& centre_W)
    : selection_(std::make_unique<Selection>(compute, map)) {
  selection_->map.reset(centre_W);
}

SelectedBlocks::~SelectedBlocks() = default;

void SelectedBlocks::add(const DepthFrame& frame, const Pose& T_W_D) {
  SelectionArgs args = selectionArgs(selection_->map.parameters(), frame.levels[0].camera);
  args.capacity = kCapacity;
  for (bool list_was_full = true; list_was_full;) {
    selection_->count.fill(0, sizeof(int));
    selection_->points_outside.fill(0, sizeof(int));
    selection_->kernels.requestBlocks(frame, selection_->map, selection_->requests, selection_->count,
                                      selection_->points_outside, T_W_D, args);
    const int count = selection_->count.read<int>(1).front();
    list_was_full = count > kCapacity;
    claimed_ += std::min(count, kCapacity);
  }
}

size_t SelectedBlocks::kept() const {
  const MapParameters& map = selection_->map.parameters();
  const double band_vox = 2.0 * map.truncation_m / map.voxel_size_m;
  const double voxels_extent = band_vox + kMeanCubeExtent * (map.block_size - 1);
  return std::lround(claimed_ * voxels_extent / (band_vox + kMeanCubeExtent * map.block_size));
}

}  // namespace depth_fusion
