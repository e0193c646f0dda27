#include <algorithm>
#include <cmath>

#include "tools/evaluation/block_count.h"

namespace depth_fusion {
namespace {

// Holds a window of blocks, and which of them have been met.
class MetBlocks {
 public:
  MetBlocks(const MapParameters& map, const Eigen::Vector3d& centre_W)
      : window_(Window::centredOn(centre_W, static_cast<double>(map.voxel_size_m) * map.block_size,
                                  map.blocks_per_axis)),
        block_vox_(map.block_size),
        per_voxel_(1.0 / map.voxel_size_m),
        met_(window_.blockCount()) {}

  // A point between the block's first voxels and the next block's is within reach of neither's.
  void meet(const Eigen::Vector3d& p_W) {
    const Eigen::Array3d voxel = p_W.array() * per_voxel_;
    const Eigen::Array3d block = (voxel / block_vox_).floor();
    if (((voxel - block * block_vox_) > block_vox_ - 1).any()) return;
    const BlockIndex index = block.cast<int>();
    if (window_.contains(index)) met_[window_.address(index)] = true;
  }

  size_t count() const { return std::count(met_.begin(), met_.end(), true); }

 private:
  Window window_;
  int block_vox_;
  double per_voxel_;
  std::vector<bool> met_;
};

// Calls visit(point) on a grid over the triangle whose points lie at most spacing_m apart along its sides.
template <class Visit>
void forEachPoint(const Eigen::Vector3d corners[3], double spacing_m, const Visit& visit) {
  const Eigen::Vector3d side_1 = corners[1] - corners[0], side_2 = corners[2] - corners[0];
  const double longest_m = std::max({side_1.norm(), side_2.norm(), (side_2 - side_1).norm()});
  const int steps = std::max(1, static_cast<int>(std::ceil(longest_m / spacing_m)));
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; i + j <= steps; ++j) visit(corners[0] + (i * side_1 + j * side_2) / steps);
  }
}

}  // namespace

size_t blocksAround(const TriangleMesh& mesh, const MapParameters& map, const Eigen::Vector3d& centre_W) {
  MetBlocks met(map, centre_W);
  const double truncation_m = map.truncation_m > 0.0f ? map.truncation_m : 4.0 * map.voxel_size_m;
  const double spacing_m = map.voxel_size_m * std::max(1.0, map.block_size / 8.0);
  const int steps = static_cast<int>(std::ceil(2.0 * truncation_m / spacing_m));
  for (const MeshTriangle& triangle : mesh.triangles) {
    Eigen::Vector3d corners[3];
    for (int i = 0; i < 3; ++i) corners[i] = mesh.vertices[triangle[i]].position_W.cast<double>();
    const Eigen::Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
    forEachPoint(corners, spacing_m, [&](const Eigen::Vector3d& p_W) {
      for (int i = 0; i <= steps; ++i) met.meet(p_W + truncation_m * (2.0 * i / steps - 1.0) * normal);
    });
  }
  return met.count();
}

}  // namespace depth_fusion
