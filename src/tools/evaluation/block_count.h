// How many blocks of a map a surface meets, without a map being filled.
#pragma once

#include <memory>

#include "depth_fusion/map/block_map.h"
#include "depth_fusion/preprocessing/depth_preprocessor.h"
#include "depth_fusion/surface_mesh/triangle_mesh.h"

namespace depth_fusion {

// Counts by block selection itself, which claims each block once; no block is allocated for the claims. It
// takes 4 * N^3 bytes.
class SelectedBlocks {
 public:
  // The window's middle is the block with the point centre_W.
  SelectedBlocks(ComputeContext& compute, const MapParameters& map, const Eigen::Vector3d& centre_W);
  ~SelectedBlocks();

  void add(const DepthFrame& frame, const Pose& T_W_D);

  size_t claimed() const { return claimed_; }
  // The claimed blocks that fusion keeps: a claim needs a point of the truncation band in the block, data
  // needs one of its voxels there, and those end a voxel short of the block's far sides.
  size_t kept() const;

 private:
  struct Selection;

  size_t claimed_ = 0;
  std::unique_ptr<Selection> selection_;
};

// Counts the blocks of the map's window that have a voxel within the truncation of the mesh, along its
// normals.
size_t blocksAround(const TriangleMesh& mesh, const MapParameters& map, const Eigen::Vector3d& centre_W);

}  // namespace depth_fusion
