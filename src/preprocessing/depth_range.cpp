#include "depth_fusion/preprocessing/depth_range.h"

namespace depth_fusion {

cv::Mat depthInRange(const RgbdFrame& frame, const DepthRange& range) {
  cv::Mat mask;
  cv::inRange(frame.depth, range.min_m / frame.depth_unit_m, range.max_m / frame.depth_unit_m, mask);
  return mask;
}

Eigen::Vector3d windowCentre(const RgbdFrame& frame, const DepthRange& range, const Pose& T_W_D) {
  const double ahead_m = frame.depth_unit_m * cv::mean(frame.depth, depthInRange(frame, range))[0];
  return T_W_D * Eigen::Vector3d(0.0, 0.0, ahead_m);
}

}  // namespace depth_fusion
