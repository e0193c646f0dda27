// Maps of simple surfaces, and their meshes.
#pragma once

#include <gtest/gtest.h>

#include "depth_fusion/surface_mesh/surface_mesh.h"
#include "reference/map_from_distance.h"
#include "support/test_compute.h"

namespace depth_fusion {

inline SignedDistance sphere(const Eigen::Vector3d& centre, double radius) {
  return [=](const Eigen::Vector3d& p) { return (p - centre).norm() - radius; };
}

class SurfaceMesh : public testing::Test {
 protected:
  static MapParameters parameters(int block_size, int blocks_per_axis = 32) {
    MapParameters parameters;
    parameters.voxel_size_m = 0.005f;
    parameters.truncation_m = 0.02f;
    parameters.block_size = block_size;
    parameters.blocks_per_axis = blocks_per_axis;
    parameters.pool_mib = 64;
    return parameters;
  }

  static TriangleMesh meshOf(BlockMap& map, const SurfaceMeshParameters& parameters = {}) {
    TriangleMesh mesh;
    exportSurfaceMesh(compute(), map, mesh, parameters);
    return mesh;
  }
};

}  // namespace depth_fusion
