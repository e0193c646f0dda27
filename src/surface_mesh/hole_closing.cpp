#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <unordered_map>
#include <unordered_set>

#include "depth_fusion/surface_mesh/mesh_repair.h"

namespace depth_fusion {
namespace {

constexpr size_t kMostEdges = 500;

using Loop = std::vector<uint32_t>;  // vertices, counter-clockwise as the hole's triangles must have them
using Edges = std::unordered_set<uint64_t>;

uint64_t directed(uint32_t from, uint32_t to) { return uint64_t{from} << 32 | to; }
uint64_t undirected(uint32_t a, uint32_t b) { return directed(std::min(a, b), std::max(a, b)); }

// The borders of the surface as loops; where several meet at a vertex, each is a loop of its own.
std::vector<Loop> bordersOf(const std::vector<MeshTriangle>& triangles) {
  Edges edges;
  for (const MeshTriangle& t : triangles) {
    for (int i = 0; i < 3; ++i) edges.insert(directed(t[i], t[(i + 1) % 3]));
  }
  std::unordered_multimap<uint32_t, uint32_t> next;  // along the hole's side of the border
  std::vector<uint32_t> begins;
  for (const MeshTriangle& t : triangles) {
    for (int i = 0; i < 3; ++i) {
      const uint32_t from = t[(i + 1) % 3], to = t[i];
      if (edges.count(directed(from, to)) > 0) continue;
      next.emplace(from, to);
      begins.push_back(from);
    }
  }
  std::vector<Loop> loops;
  for (const uint32_t begin : begins) {
    Loop way = {begin};
    std::unordered_map<uint32_t, size_t> place_on_way = {{begin, 0}};
    for (auto step = next.find(begin); step != next.end(); step = next.find(way.back())) {
      const uint32_t vertex = step->second;
      next.erase(step);
      const auto met = place_on_way.find(vertex);
      if (met == place_on_way.end()) {
        place_on_way.emplace(vertex, way.size());
        way.push_back(vertex);
        continue;
      }
      const auto loop_begin = way.begin() + static_cast<std::ptrdiff_t>(met->second);
      loops.emplace_back(loop_begin, way.end());
      for (auto it = loop_begin + 1; it != way.end(); ++it) place_on_way.erase(*it);
      way.erase(loop_begin + 1, way.end());
    }
  }
  return loops;
}

double size_m(const TriangleMesh& mesh, const Loop& loop) {
  Eigen::AlignedBox3f box;
  for (const uint32_t vertex : loop) box.extend(mesh.vertices[vertex].position_W);
  return static_cast<double>(box.diagonal().norm());
}

// The least area of triangles between the vertices first..last of a loop, by dynamic programming: the edge
// from first to last has a triangle whose third vertex lies between them.
class LeastArea {
 public:
  LeastArea(const TriangleMesh& mesh, const Loop& loop, const Edges& taken)
      : loop_(loop), count_(loop.size()), areas_(count_ * count_, 0.0f), thirds_(count_ * count_, 0) {
    for (size_t length = 2; length < count_; ++length) {
      for (size_t first = 0; first + length < count_; ++first) fill(mesh, taken, first, first + length);
    }
  }

  bool isPossible() const { return areas_[count_ - 1] < kImpossible; }

  void collect(size_t first, size_t last, std::vector<MeshTriangle>& triangles) const {
    if (last - first < 2) return;
    const size_t third = thirds_[first * count_ + last];
    triangles.push_back({loop_[first], loop_[third], loop_[last]});
    collect(first, third, triangles);
    collect(third, last, triangles);
  }

 private:
  static constexpr float kImpossible = std::numeric_limits<float>::max();

  void fill(const TriangleMesh& mesh, const Edges& taken, size_t first, size_t last) {
    const auto position = [&](size_t i) { return mesh.vertices[loop_[i]].position_W; };
    float& least = areas_[first * count_ + last];
    least = kImpossible;
    const bool is_border = last - first == count_ - 1;
    if (!is_border && taken.count(undirected(loop_[first], loop_[last])) > 0) return;
    const Eigen::Vector3f base = position(last) - position(first);
    for (size_t third = first + 1; third < last; ++third) {
      const float before = areas_[first * count_ + third], behind = areas_[third * count_ + last];
      if (before >= kImpossible || behind >= kImpossible) continue;
      const float area = before + behind + 0.5f * base.cross(position(third) - position(first)).norm();
      if (area >= least) continue;
      least = area;
      thirds_[first * count_ + last] = third;
    }
  }

  const Loop& loop_;
  const size_t count_;
  std::vector<float> areas_;
  std::vector<size_t> thirds_;
};

}  // namespace

HoleClosing withHolesClosed(const TriangleMesh& mesh, double max_size_m) {
  HoleClosing result;
  result.mesh = mesh;
  std::vector<MeshTriangle>& triangles = result.mesh.triangles;
  Edges taken;
  for (const MeshTriangle& t : triangles) {
    for (int i = 0; i < 3; ++i) taken.insert(undirected(t[i], t[(i + 1) % 3]));
  }
  for (const Loop& loop : bordersOf(mesh.triangles)) {
    const bool is_small = loop.size() >= 3 && loop.size() <= kMostEdges && size_m(mesh, loop) <= max_size_m;
    const size_t before = triangles.size();
    if (is_small) {
      const LeastArea patch(mesh, loop, taken);
      if (patch.isPossible()) patch.collect(0, loop.size() - 1, triangles);
    }
    ++(triangles.size() > before ? result.closed : result.left);
    for (size_t i = before; i < triangles.size(); ++i) {
      for (int k = 0; k < 3; ++k) taken.insert(undirected(triangles[i][k], triangles[i][(k + 1) % 3]));
    }
  }
  return result;
}

}  // namespace depth_fusion
