// A union of solids: what simulated recordings show, and the exact surface that meshes are measured against.
#pragma once

#include <vector>

#include "tools/simulation/solid_tree.h"

namespace depth_fusion {

class Scene {
 public:
  explicit Scene(std::vector<Primitive> primitives)
      : primitives_(std::move(primitives)), tree_(primitives_) {}

  // Returns the signed distance to the surface in metres, positive in free space. It is exact there; inside
  // it is exact wherever solids do not overlap, and never too large in magnitude.
  double distance(const Eigen::Vector3d& p_W) const;

  const std::vector<Primitive>& primitives() const { return primitives_; }
  const SolidTree& tree() const { return tree_; }

 private:
  std::vector<Primitive> primitives_;
  SolidTree tree_;
};

}  // namespace depth_fusion
