// What a viewer has that is told of the changes of mesh chunks.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <set>
#include <tuple>
#include <vector>

#include "depth_fusion/surface_mesh/mesh_chunks.h"
#include "depth_fusion/surface_mesh/surface_mesh.h"
#include "support/test_compute.h"

namespace depth_fusion {

using ChunkIndices = std::set<MeshChunkIndex>;

// A vertex with everything that belongs to it.
struct Corner {
  std::array<float, 6> vertex;
  MeshColor color;
  bool operator<(const Corner& other) const {
    return std::tie(vertex, color) < std::tie(other.vertex, other.color);
  }
  bool operator==(const Corner& other) const { return vertex == other.vertex && color == other.color; }
};
using Triangles = std::vector<std::array<Corner, 3>>;

inline Corner cornerOf(const TriangleMesh& mesh, uint32_t vertex) {
  Corner corner{};
  std::memcpy(corner.vertex.data(), &mesh.vertices.at(vertex), sizeof(MeshVertex));
  if (!mesh.colors.empty()) corner.color = mesh.colors.at(vertex);
  return corner;
}

inline void addTriangles(const TriangleMesh& mesh, Triangles& triangles) {
  for (const MeshTriangle& t : mesh.triangles) {
    std::array<Corner, 3> corners = {cornerOf(mesh, t[0]), cornerOf(mesh, t[1]), cornerOf(mesh, t[2])};
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    triangles.push_back(corners);
  }
}

class ChunkViewer {
 public:
  // Returns the chunks that it was told of.
  ChunkIndices follow(MeshChunks& chunks, size_t max_count = SIZE_MAX) {
    ChunkIndices told;
    for (MeshChunk& chunk : chunks.takeChanged(max_count)) {
      EXPECT_TRUE(told.insert(chunk.index).second) << "told of twice";
      if (chunk.mesh.triangles.empty()) {
        EXPECT_EQ(meshes_.erase(chunk.index), 1u) << "is gone but was never there";
      } else {
        meshes_[chunk.index] = std::move(chunk.mesh);
      }
    }
    return told;
  }

  ChunkIndices shown() const {
    ChunkIndices indices;
    for (const auto& entry : meshes_) indices.insert(entry.first);
    return indices;
  }

  void expectTheWholeSurface(BlockMap& map, const SurfaceMeshParameters& parameters = {}) const {
    TriangleMesh whole;
    exportSurfaceMesh(compute(), map, whole, parameters);
    Triangles expected, seen;
    addTriangles(whole, expected);
    for (const auto& entry : meshes_) {
      addTriangles(entry.second, seen);
      expectNoUnusedVertex(entry.second);
    }
    std::sort(expected.begin(), expected.end());
    std::sort(seen.begin(), seen.end());
    EXPECT_EQ(seen.size(), expected.size());
    EXPECT_TRUE(seen == expected);
  }

 private:
  static void expectNoUnusedVertex(const TriangleMesh& mesh) {
    std::vector<bool> used(mesh.vertices.size(), false);
    for (const MeshTriangle& triangle : mesh.triangles) {
      for (const uint32_t vertex : triangle) used.at(vertex) = true;
    }
    EXPECT_EQ(std::count(used.begin(), used.end(), false), 0);
  }

  std::map<MeshChunkIndex, TriangleMesh> meshes_;
};

}  // namespace depth_fusion
