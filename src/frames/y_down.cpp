#include "depth_fusion/frames/y_down.h"

#include <cmath>

namespace depth_fusion {

Pose mirroredY(const Pose& pose) {
  const Eigen::DiagonalMatrix<double, 3> mirror(1.0, -1.0, 1.0);
  Pose mirrored = pose;
  mirrored.linear() = mirror * pose.linear() * mirror;
  mirrored.translation() = mirror * pose.translation();
  return mirrored;
}

void makeYDown(RgbdFrame& frame) {
  if (!(frame.intrinsics.fy < 0.0)) return;
  frame.y_mirrored = true;
  frame.readings = {};  // of a robot that is none in a mirror
  frame.intrinsics.fy = -frame.intrinsics.fy;
  if (frame.color_intrinsics) frame.color_intrinsics->fy = std::abs(frame.color_intrinsics->fy);
  if (frame.T_C_D) frame.T_C_D = mirroredY(*frame.T_C_D);
  if (frame.T_W_D) frame.T_W_D = mirroredY(*frame.T_W_D);
}

}  // namespace depth_fusion
