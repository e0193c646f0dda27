#include "tools/simulation/scene.h"

#include <algorithm>
#include <limits>

namespace depth_fusion {

double Scene::distance(const Eigen::Vector3d& p_W) const {
  double distance = std::numeric_limits<double>::infinity();
  for (const Primitive& primitive : primitives_) distance = std::min(distance, primitive.distance(p_W));
  return distance;
}

}  // namespace depth_fusion
