#include "depth_fusion/esdf/octree_file.h"

#include <filesystem>

#include "depth_fusion/common/error.h"
#ifdef DEPTH_FUSION_HAS_OCTOMAP
#include <octomap/OcTree.h>
#endif

namespace depth_fusion {

#ifdef DEPTH_FUSION_HAS_OCTOMAP

bool hasOctrees() { return true; }

OctreeSize writeOctree(const std::string& path, const EsdfGrid& space) {
  const std::string ending = std::filesystem::path(path).extension().string();
  check(ending == ".bt" || ending == ".ot", "the path " + path + " ends neither with .bt nor with .ot");
  octomap::OcTree tree(space.cellSize_m());
  OctreeSize size;
  space.forEachCell([&](const Eigen::Vector3i& cell, CellState state, float) {
    if (state == CellState::kUnknown) return;
    const Eigen::Vector3d middle = space.middleOf(cell);
    const bool is_occupied = state == CellState::kOccupied;
    tree.setNodeValue(octomap::point3d(static_cast<float>(middle.x()), static_cast<float>(middle.y()),
                                       static_cast<float>(middle.z())),
                      is_occupied ? tree.getClampingThresMaxLog() : tree.getClampingThresMinLog(), true);
    ++(is_occupied ? size.occupied : size.free);
  });
  check(size.occupied + size.free > 0, "nothing is known of space yet; nothing was written");
  tree.updateInnerOccupancy();
  tree.prune();
  const bool is_written = ending == ".bt" ? tree.writeBinaryConst(path) : tree.write(path);
  check(is_written && std::filesystem::exists(path), "cannot write " + path);
  size.bytes = std::filesystem::file_size(path);
  return size;
}

#else

bool hasOctrees() { return false; }

OctreeSize writeOctree(const std::string& path, const EsdfGrid&) {
  throw Error("cannot write " + path + ": this was built without OctoMap (liboctomap-dev)");
}

#endif

}  // namespace depth_fusion
