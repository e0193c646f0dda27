#include <Eigen/Geometry>
#include <numeric>
#include <utility>

#include "depth_fusion/surface_mesh/mesh_repair.h"
#include "surface_mesh/mesh_part.h"

namespace depth_fusion {
namespace {

// Sets that are joined one by one.
class JoinedSets {
 public:
  explicit JoinedSets(size_t count) : parents_(count) { std::iota(parents_.begin(), parents_.end(), 0u); }

  uint32_t rootOf(uint32_t element) {
    while (parents_[element] != element) element = parents_[element] = parents_[parents_[element]];
    return element;
  }
  void join(uint32_t a, uint32_t b) { parents_[rootOf(a)] = rootOf(b); }

 private:
  std::vector<uint32_t> parents_;
};

}  // namespace

IslandRemoval withoutIslands(const TriangleMesh& mesh, double min_size_m) {
  JoinedSets sets(mesh.vertices.size());
  for (const MeshTriangle& t : mesh.triangles) {
    sets.join(t[0], t[1]);
    sets.join(t[0], t[2]);
  }
  std::vector<Eigen::AlignedBox3f> boxes(mesh.vertices.size());
  for (const MeshTriangle& t : mesh.triangles) {
    for (const uint32_t vertex : t) boxes[sets.rootOf(vertex)].extend(mesh.vertices[vertex].position_W);
  }
  const auto isSmall = [&](const Eigen::AlignedBox3f& box) {
    return static_cast<double>(box.diagonal().norm()) < min_size_m;
  };
  std::vector<MeshTriangle> kept;
  for (const MeshTriangle& t : mesh.triangles) {
    if (!isSmall(boxes[sets.rootOf(t[0])])) kept.push_back(t);
  }
  IslandRemoval result;
  for (const Eigen::AlignedBox3f& box : boxes) result.removed += !box.isEmpty() && isSmall(box);
  result.mesh = partOf(mesh, kept);
  return result;
}

}  // namespace depth_fusion
