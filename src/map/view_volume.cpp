#include "map/view_volume.h"

#include <algorithm>

namespace depth_fusion {

ViewVolume::ViewVolume(const CameraIntrinsics& camera, const Pose& T_D_W, double max_range_m) {
  const auto inW = [&](const Eigen::Vector3d& normal_D, double offset) {
    return HalfSpace{T_D_W.linear().transpose() * normal_D, normal_D.dot(T_D_W.translation()) + offset};
  };
  sides_ = {inW({0.0, 0.0, 1.0}, 0.0),
            inW({0.0, 0.0, -1.0}, max_range_m),
            inW({camera.fx, 0.0, camera.cx + 1.0}, 0.0),
            inW({-camera.fx, 0.0, camera.width - camera.cx}, 0.0),
            inW({0.0, camera.fy, camera.cy + 1.0}, 0.0),
            inW({0.0, -camera.fy, camera.height - camera.cy}, 0.0)};
  const Pose T_W_D = T_D_W.inverse();
  box_.extend(T_W_D.translation());
  for (const double u : {-1.0, static_cast<double>(camera.width)}) {
    for (const double v : {-1.0, static_cast<double>(camera.height)})
      box_.extend(T_W_D * (max_range_m *
                           Eigen::Vector3d((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1.0)));
  }
}

bool ViewVolume::meets(const Eigen::Vector3d& centre_W, const Eigen::Vector3d& half_extent_m) const {
  return std::all_of(sides_.begin(), sides_.end(), [&](const HalfSpace& side) {
    return side.normal.dot(centre_W) + side.normal.cwiseAbs().dot(half_extent_m) + side.offset >= 0.0;
  });
}

}  // namespace depth_fusion
