#include "depth_fusion/surface_mesh/simplification.h"

#include <algorithm>

#include "depth_fusion/common/error.h"
#include "surface_mesh/mesh_part.h"

#ifdef DEPTH_FUSION_HAS_MESHOPTIMIZER
#include <meshoptimizer.h>
#endif

namespace depth_fusion {
namespace {

#ifdef DEPTH_FUSION_HAS_MESHOPTIMIZER

constexpr bool kCanSimplify = true;

static_assert(sizeof(MeshTriangle) == 3 * sizeof(unsigned int), "a triangle is three indices");

std::vector<MeshTriangle> fewerTriangles(const TriangleMesh& mesh, const SimplificationGoal& goal,
                                         OpenBorders borders) {
  const float* positions = mesh.vertices.data()->position_W.data();
  // meshoptimizer's errors are shares of the mesh's extent.
  const double extent_m =
      static_cast<double>(meshopt_simplifyScale(positions, mesh.vertices.size(), sizeof(MeshVertex)));
  const auto max_error = static_cast<float>(std::min(1.0, goal.max_error_m / std::max(extent_m, 1e-9)));
  const unsigned int options = borders == OpenBorders::kStay ? meshopt_SimplifyLockBorder : 0;
  std::vector<MeshTriangle> triangles(mesh.triangles.size());
  const size_t indices = meshopt_simplify(
      triangles.data()->data(), mesh.triangles.data()->data(), 3 * mesh.triangles.size(), positions,
      mesh.vertices.size(), sizeof(MeshVertex), 3 * goal.triangles, max_error, options, nullptr);
  triangles.resize(indices / 3);
  return triangles;
}

#else

constexpr bool kCanSimplify = false;

std::vector<MeshTriangle> fewerTriangles(const TriangleMesh&, const SimplificationGoal&, OpenBorders) {
  throw Error(
      "this depth_fusion was built without meshoptimizer, which simplifies meshes; install "
      "libmeshoptimizer-dev and "
      "build again, or keep all the triangles");
}

#endif

}  // namespace

bool canSimplify() { return kCanSimplify; }

TriangleMesh simplified(const TriangleMesh& mesh, double ratio, OpenBorders borders) {
  check(ratio > 0.0 && ratio <= 1.0,
        "the share of triangles to keep is " + std::to_string(ratio) + "; it must be above 0 and at most 1");
  if (ratio == 1.0 || mesh.triangles.empty()) return mesh;
  const auto kept = static_cast<size_t>(ratio * static_cast<double>(mesh.triangles.size()));
  return simplified(mesh, SimplificationGoal{kept}, borders);
}

TriangleMesh simplified(const TriangleMesh& mesh, const SimplificationGoal& goal, OpenBorders borders) {
  if (mesh.triangles.size() <= goal.triangles) return mesh;
  return partOf(mesh, fewerTriangles(mesh, goal, borders));
}

}  // namespace depth_fusion
