#include "texturing/face_neighbours.h"

#include <algorithm>

namespace depth_fusion {
namespace {

struct Edge {
  uint32_t low, high;  // vertices
  uint32_t side;       // three times its face and the number of its first corner

  bool operator<(const Edge& other) const {
    return low != other.low ? low < other.low : high != other.high ? high < other.high : side < other.side;
  }
  bool isAlong(const Edge& other) const { return low == other.low && high == other.high; }
};

}  // namespace

FaceNeighbours neighboursOf(const std::vector<MeshTriangle>& triangles) {
  std::vector<Edge> edges;
  edges.reserve(3 * triangles.size());
  for (uint32_t face = 0; face < triangles.size(); ++face) {
    for (uint32_t i = 0; i < 3; ++i) {
      const uint32_t a = triangles[face][i], b = triangles[face][(i + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), 3 * face + i});
    }
  }
  std::sort(edges.begin(), edges.end());
  FaceNeighbours neighbours(triangles.size(), {kNoFace, kNoFace, kNoFace});
  for (size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end].isAlong(edges[begin])) ++end;
    if (end - begin != 2) continue;
    const uint32_t one = edges[begin].side, other = edges[begin + 1].side;
    neighbours[one / 3][one % 3] = other / 3;
    neighbours[other / 3][other % 3] = one / 3;
  }
  return neighbours;
}

}  // namespace depth_fusion
