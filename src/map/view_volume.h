// What a camera's image shows of space.
#pragma once

#include <array>

#include "depth_fusion/geometry/camera_intrinsics.h"
#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

// The points in front of a camera up to a depth, in the image and a pixel beside.
class ViewVolume {
 public:
  ViewVolume(const CameraIntrinsics& camera, const Pose& T_D_W, double max_range_m);

  // Whether a box along the axes of W may reach into it.
  bool meets(const Eigen::Vector3d& centre_W, const Eigen::Vector3d& half_extent_m) const;
  // The box of W about it.
  Eigen::AlignedBox3d box() const { return box_; }

 private:
  // The points p of W with normal . p + offset >= 0.
  struct HalfSpace {
    Eigen::Vector3d normal;
    double offset;
  };

  std::array<HalfSpace, 6> sides_;
  Eigen::AlignedBox3d box_;
};

}  // namespace depth_fusion
