#include "tools/simulation/scene.h"

#include <algorithm>
#include <limits>

namespace depth_fusion {

double Scene::distance(const Eigen::Vector3d& p_W) const {
  double distance_m = std::numeric_limits<double>::infinity();
  const auto may_be_nearer = [&](const Eigen::AlignedBox3d& box_W) {
    return box_W.exteriorDistance(p_W) <= std::max(distance_m, 0.0);
  };
  tree_.visit(may_be_nearer, [&](int i) { distance_m = std::min(distance_m, primitives_[i].distance(p_W)); });
  return distance_m;
}

}  // namespace depth_fusion
