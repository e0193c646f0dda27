#include "depth_fusion/surface_mesh/simplification.h"

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

std::vector<MeshTriangle> fewerTriangles(const TriangleMesh& mesh, double ratio, OpenBorders borders) {
  constexpr float kAnyError = 1.0f;  // the mesh's extent
  const unsigned int options = borders == OpenBorders::kStay ? meshopt_SimplifyLockBorder : 0;
  const size_t kept = static_cast<size_t>(ratio * static_cast<double>(mesh.triangles.size()));
  std::vector<MeshTriangle> triangles(mesh.triangles.size());
  const size_t indices =
      meshopt_simplify(triangles.data()->data(), mesh.triangles.data()->data(), 3 * mesh.triangles.size(),
                       mesh.vertices.data()->position_W.data(), mesh.vertices.size(), sizeof(MeshVertex),
                       3 * kept, kAnyError, options, nullptr);
  triangles.resize(indices / 3);
  return triangles;
}

#else

constexpr bool kCanSimplify = false;

std::vector<MeshTriangle> fewerTriangles(const TriangleMesh&, double, OpenBorders) {
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
  return partOf(mesh, fewerTriangles(mesh, ratio, borders));
}

}  // namespace depth_fusion
