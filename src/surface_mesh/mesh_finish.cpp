#include "depth_fusion/surface_mesh/mesh_finish.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "depth_fusion/common/error.h"
#include "depth_fusion/surface_mesh/mesh_repair.h"
#include "depth_fusion/surface_mesh/simplification.h"

namespace depth_fusion {
namespace {

bool simplifies(const MeshFinish& finish) {
  return finish.share < 1.0 || finish.max_triangles > 0 || finish.max_error_m > 0.0;
}

void checkSize(double size_m, const std::string& name) {
  check(std::isfinite(size_m) && size_m >= 0.0,
        name + " is a size in metres, 0 for none; it is " + std::to_string(size_m));
}

// The error alone leaves the number of triangles open.
SimplificationGoal goalOf(const MeshFinish& finish, size_t triangles) {
  SimplificationGoal goal;
  if (finish.max_error_m > 0.0) goal.max_error_m = finish.max_error_m;
  goal.triangles = finish.share < 1.0 || finish.max_triangles > 0 ? triangles : 0;
  if (finish.share < 1.0) goal.triangles = static_cast<size_t>(finish.share * static_cast<double>(triangles));
  if (finish.max_triangles > 0) goal.triangles = std::min(goal.triangles, finish.max_triangles);
  return goal;
}

void append(std::string& remark, const std::string& text) { remark += (remark.empty() ? "" : ", ") + text; }

}  // namespace

bool MeshFinish::changesMesh() const { return min_island_m > 0.0 || max_hole_m > 0.0 || simplifies(*this); }

void checkFinish(const MeshFinish& finish) {
  checkSize(finish.min_island_m, "the smallest island");
  checkSize(finish.max_hole_m, "the largest hole");
  checkSize(finish.max_error_m, "the simplification's error");
  check(finish.share > 0.0 && finish.share <= 1.0, "the share of triangles to keep is " +
                                                       std::to_string(finish.share) +
                                                       "; it must be above 0 and at most 1");
}

FinishedMesh finished(TriangleMesh mesh, const MeshFinish& finish) {
  checkFinish(finish);
  FinishedMesh result{std::move(mesh), ""};
  if (finish.min_island_m > 0.0) {
    IslandRemoval removal = withoutIslands(result.mesh, finish.min_island_m);
    result.mesh = std::move(removal.mesh);
    append(result.remark, std::to_string(removal.removed) + " islands removed");
  }
  if (finish.max_hole_m > 0.0) {
    HoleClosing closing = withHolesClosed(result.mesh, finish.max_hole_m);
    result.mesh = std::move(closing.mesh);
    append(result.remark,
           std::to_string(closing.closed) + " holes closed, " + std::to_string(closing.left) + " left open");
  }
  if (simplifies(finish)) {
    const size_t before = result.mesh.triangles.size();
    result.mesh = simplified(result.mesh, goalOf(finish, before));
    append(result.remark, std::to_string(result.mesh.triangles.size()) + " of " + std::to_string(before) +
                              " triangles kept");
  }
  return result;
}

}  // namespace depth_fusion
