// Keyframes for loops, of simulated scenes seen from poses of the test's choice.
#pragma once

#include <memory>

#include "depth_fusion/relocalisation/keyframe.h"
#include "depth_fusion/texture_odometry/texture_odometry.h"
#include "support/simulated_frames.h"
#include "tools/simulation/scene_library.h"

namespace depth_fusion {

constexpr int kLoopViewWidth_px = 320;

inline Keyframe loopKeyframe(const RgbdFrame& frame, const Pose& T_W_D, double way_m) {
  Keyframe keyframe = keyframeOf(TextureOdometry({}).extract(frame), T_W_D, frame.stamp_s);
  keyframe.view = KeyframeView(frame.depth, frame.intrinsics, kLoopViewWidth_px);
  keyframe.way_m = way_m;
  return keyframe;
}

class LoopScene {
 public:
  explicit LoopScene(const std::string& name)
      : scene_(makeScene(name)), camera_(halved(scene_.sensor.camera)) {}

  // What a camera at T_scene_D sees.
  RgbdFrame frame(const Pose& T_scene_D, uint64_t seed) const {
    return frameOf(render(scene_.surface, camera_, T_scene_D), scene_.sensor, camera_, seed);
  }
  const Scene& surface() const { return scene_.surface; }
  Keyframe keyframe(const Pose& T_scene_D, const Pose& T_W_D, double way_m, uint64_t seed) const {
    return loopKeyframe(frame(T_scene_D, seed), T_W_D, way_m);
  }

 private:
  SimulatedScene scene_;
  CameraIntrinsics camera_;
};

// A camera at that place of a floor, as high as an eye, which looks along the yaw.
inline Pose standingAt(double x_m, double y_m, double yaw_rad) {
  Eigen::Matrix3d axes;  // right, down, forward
  axes << std::sin(yaw_rad), 0.0, std::cos(yaw_rad), -std::cos(yaw_rad), 0.0, std::sin(yaw_rad), 0.0, -1.0,
      0.0;
  Pose pose = Pose::Identity();
  pose.linear() = axes;
  pose.translation() = Eigen::Vector3d(x_m, y_m, 1.4);
  return pose;
}

}  // namespace depth_fusion
