#include <cmath>

#include "tools/evaluation/block_count.h"
#include "tsdf_fusion/block_selection.h"

namespace depth_fusion {
namespace {

// The mean of |n_x| + |n_y| + |n_z| over all unit normals is the mean extent of a cube of edge 1 along them.
constexpr double kMeanCubeExtent = 1.5;

MapParameters withSmallestPool(MapParameters map) {
  map.pool_mib = 1;
  map.color = false;
  return map;
}

}  // namespace

struct SelectedBlocks::Selection {
  BlockMap map;
  TsdfFusion::Kernels kernels;
  BlockSelection blocks;

  Selection(ComputeContext& compute, const MapParameters& parameters)
      : map(compute, withSmallestPool(parameters)), kernels(compute, map), blocks(compute, kernels) {}
};

SelectedBlocks::SelectedBlocks(ComputeContext& compute, const MapParameters& map,
                               const Eigen::Vector3d& centre_W)
    : selection_(std::make_unique<Selection>(compute, map)) {
  selection_->map.placeWindow(centre_W);
}

SelectedBlocks::~SelectedBlocks() = default;

void SelectedBlocks::add(const DepthFrame& frame, const Pose& T_W_D) {
  selection_->blocks.select(frame, selection_->map, T_W_D, [this](const std::vector<BlockIndex>& claimed) {
    claimed_ += claimed.size();
    return true;
  });
}

size_t SelectedBlocks::kept() const {
  const MapParameters& map = selection_->map.parameters();
  const double band_vox = 2.0 * map.truncation_m / map.voxel_size_m;
  const double voxels_extent = band_vox + kMeanCubeExtent * (map.block_size - 1);
  return std::lround(static_cast<double>(claimed_) * voxels_extent /
                     (band_vox + kMeanCubeExtent * map.block_size));
}

}  // namespace depth_fusion
