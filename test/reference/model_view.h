// Ray casting of a map, plainly: one ray in small steps through all of the view's range, in double.
#pragma once

#include <cmath>

#include "depth_fusion/model_view/model_view_renderer.h"
#include "shared/types.h"
#include "support/map_contents.h"

namespace depth_fusion::reference {

class RayCaster {
 public:
  explicit RayCaster(BlockMap& map) : map_(map.parameters()), content_(readMap(map)) {}

  // Returns the depth of the first place where the ray (z = 1) goes from free space through the surface; 0 =
  // none.
  double cast(const Pose& T_W_D, const Eigen::Vector3d& ray_D, double min_range_m, double max_range_m) const {
    const double step_m = 0.25 * map_.voxel_size_m / ray_D.norm();
    double previous = std::nan("");
    for (double t = min_range_m; t < max_range_m; t += step_m) {
      const double distance = interpolated(T_W_D * Eigen::Vector3d(t * ray_D));
      if (distance <= 0.0 && previous > 0.0) return t - step_m * distance / (distance - previous);
      previous = distance;
    }
    return 0.0;
  }

 private:
  // Interpolates the distance trilinearly, in steps of the distance byte; NaN where a voxel is not known.
  double interpolated(const Eigen::Vector3d& p_W) const {
    const Eigen::Vector3d p = p_W / map_.voxel_size_m;
    const Eigen::Vector3i low = p.array().floor().cast<int>();
    const Eigen::Vector3d f = p - low.cast<double>();
    double sum = 0.0;
    for (int i = 0; i < 8; ++i) {
      const int distance = voxel(low + Eigen::Vector3i(i & 1, i >> 1 & 1, i >> 2));
      if (distance == TSDF_CHI) return std::nan("");
      sum += distance * (i & 1 ? f.x() : 1.0 - f.x()) * (i & 2 ? f.y() : 1.0 - f.y()) *
             (i & 4 ? f.z() : 1.0 - f.z());
    }
    return sum;
  }

  int voxel(const Eigen::Vector3i& voxel) const {
    const int m = map_.block_size;
    const Eigen::Vector3i block = (voxel.cast<double>() / m).array().floor().cast<int>();
    const auto found = content_.find(keyOf(block));
    if (found == content_.end()) return TSDF_CHI;
    const Eigen::Vector3i local = voxel - m * block;
    return found->second.distances[local.x() + m * (local.y() + m * local.z())];
  }

  MapParameters map_;
  MapContent content_;
};

}  // namespace depth_fusion::reference
