// Marching cubes over a dense grid, plainly: every cell in turn, vertices shared through a map keyed by edge.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "depth_fusion/surface_mesh/triangle_mesh.h"
#include "surface_mesh/marching_cubes_table.h"

namespace depth_fusion {

// Holds distance bytes of voxels first_voxel + [0, size)^3; -128 stands for unknown, as it is everywhere
// outside.
struct DenseGrid {
  Eigen::Vector3i first_voxel = Eigen::Vector3i::Zero();
  int size = 0;
  std::vector<int8_t> distances;

  DenseGrid(const Eigen::Vector3i& first, int voxels_per_axis)
      : first_voxel(first), size(voxels_per_axis), distances(static_cast<size_t>(size) * size * size, -128) {}

  template <class Visit>
  void forEachVoxel(const Visit& visit) const {
    for (int z = 0; z < size; ++z) {
      for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) visit(Eigen::Vector3i(first_voxel + Eigen::Vector3i(x, y, z)));
      }
    }
  }
  bool contains(const Eigen::Vector3i& voxel) const {
    const Eigen::Array3i local = (voxel - first_voxel).array();
    return (local >= 0).all() && (local < size).all();
  }
  int8_t& at(const Eigen::Vector3i& voxel) {
    const Eigen::Vector3i local = voxel - first_voxel;
    return distances[local.x() +
                     static_cast<size_t>(size) * (local.y() + static_cast<size_t>(size) * local.z())];
  }
  int8_t operator()(const Eigen::Vector3i& voxel) const {
    return contains(voxel) ? const_cast<DenseGrid*>(this)->at(voxel) : int8_t{-128};
  }
};

class ReferenceMarchingCubes {
 public:
  ReferenceMarchingCubes(const DenseGrid& grid, double voxel_size_m)
      : grid_(grid), voxel_size_m_(voxel_size_m) {
    grid.forEachVoxel([&](const Eigen::Vector3i& cell) { addCell(cell); });
  }

  const TriangleMesh& mesh() const { return mesh_; }

 private:
  using EdgeKey = std::array<int, 4>;  // lower voxel and axis

  static Eigen::Vector3i cornerOf(const Eigen::Vector3i& cell, int corner) {
    return cell + Eigen::Vector3i(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
  }

  void addCell(const Eigen::Vector3i& cell) {
    int cube_case = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const int distance = grid_(cornerOf(cell, corner));
      if (distance == -128) return;
      if (distance < 0) cube_case |= 1 << corner;
    }
    for (const CubeTriangle& triangle : cubeTriangles(cube_case)) {
      MeshTriangle numbers;
      for (int i = 0; i < 3; ++i)
        numbers[i] = vertexOn(cornerOf(cell, lowerCorner(triangle[i])), triangle[i] & 3);
      mesh_.triangles.push_back(numbers);
    }
  }

  uint32_t vertexOn(const Eigen::Vector3i& voxel, int axis) {
    const EdgeKey key = {voxel.x(), voxel.y(), voxel.z(), axis};
    const auto known = numbers_.find(key);
    if (known != numbers_.end()) return known->second;
    const auto number = static_cast<uint32_t>(mesh_.vertices.size());
    mesh_.vertices.push_back(makeVertex(voxel, voxel + Eigen::Vector3i::Unit(axis)));
    return numbers_[key] = number;
  }

  MeshVertex makeVertex(const Eigen::Vector3i& lower, const Eigen::Vector3i& upper) const {
    const double d0 = distance(lower);
    const double d1 = distance(upper);
    const double fraction = d0 / (d0 - d1);
    const Eigen::Vector3d position_vox =
        (1.0 - fraction) * lower.cast<double>() + fraction * upper.cast<double>();
    const Eigen::Vector3d normal = (1.0 - fraction) * gradient(lower) + fraction * gradient(upper);
    return {(voxel_size_m_ * position_vox).cast<float>(), normal.normalized().cast<float>()};
  }

  double distance(const Eigen::Vector3i& voxel) const {
    const int distance = grid_(voxel);
    return distance == 0 ? 1.0 / 16.0 : distance;
  }

  Eigen::Vector3d gradient(const Eigen::Vector3i& voxel) const {
    Eigen::Vector3d gradient;
    for (int axis = 0; axis < 3; ++axis) {
      int low = -1;
      int high = 1;
      if (grid_(voxel + low * Eigen::Vector3i::Unit(axis)) == -128) low = 0;
      if (grid_(voxel + high * Eigen::Vector3i::Unit(axis)) == -128) high = 0;
      gradient[axis] = static_cast<double>(grid_(voxel + high * Eigen::Vector3i::Unit(axis)) -
                                           grid_(voxel + low * Eigen::Vector3i::Unit(axis))) /
                       (high - low);
    }
    return gradient;
  }

  const DenseGrid& grid_;
  double voxel_size_m_;
  TriangleMesh mesh_;
  std::map<EdgeKey, uint32_t> numbers_;
};

}  // namespace depth_fusion
