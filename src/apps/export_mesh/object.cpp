#include "apps/export_mesh/object.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <string>
#include <utility>

#include "depth_fusion/common/error.h"
#include "surface_mesh/mesh_part.h"

namespace depth_fusion {
namespace {

template <class IsKept>
TriangleMesh trianglesWhere(const TriangleMesh& mesh, const IsKept& isKept) {
  std::vector<MeshTriangle> kept;
  std::copy_if(mesh.triangles.begin(), mesh.triangles.end(), std::back_inserter(kept), isKept);
  return partOf(mesh, kept);
}

TriangleMesh cropped(const TriangleMesh& mesh, const std::array<float, 6>& crop_m) {
  const Eigen::AlignedBox3f box(Eigen::Vector3f(crop_m[0], crop_m[1], crop_m[2]),
                                Eigen::Vector3f(crop_m[3], crop_m[4], crop_m[5]));
  check(!box.isEmpty(), "the box to crop to is empty; give its least x, y and z, then its most");
  return trianglesWhere(mesh, [&](const MeshTriangle& t) {
    return std::all_of(t.begin(), t.end(),
                       [&](uint32_t i) { return box.contains(mesh.vertices[i].position_W); });
  });
}

TriangleMesh withoutGround(const TriangleMesh& mesh, float above_m) {
  const Eigen::Vector4f ground = groundOf(mesh);
  return trianglesWhere(mesh, [&](const MeshTriangle& t) {
    return std::all_of(t.begin(), t.end(), [&](uint32_t i) {
      return ground.dot(mesh.vertices[i].position_W.homogeneous()) > above_m;
    });
  });
}

void append(std::string& remark, const std::string& text) { remark += (remark.empty() ? "" : ", ") + text; }

}  // namespace

FinishedMesh objectOf(TriangleMesh mesh, const ObjectOptions& options) {
  FinishedMesh object{std::move(mesh), ""};
  const auto sayLeft = [&](const std::string& what, size_t before) {
    const size_t left = object.mesh.triangles.size();
    check(left > 0, "nothing of the surface is left after it was " + what);
    append(object.remark,
           what + " (" + std::to_string(left) + " of " + std::to_string(before) + " triangles left)");
  };
  const size_t scanned = object.mesh.triangles.size();
  if (options.crop_m) {
    object.mesh = cropped(object.mesh, *options.crop_m);
    sayLeft("cropped", scanned);
  }
  const size_t with_ground = object.mesh.triangles.size();
  if (options.ground_m > 0.0f) {
    object.mesh = withoutGround(object.mesh, options.ground_m);
    sayLeft("taken off the ground", with_ground);
  }
  if (options.closed) {
    object.mesh = closedModel(object.mesh);
    append(object.remark, "closed");
  }
  return object;
}

}  // namespace depth_fusion
