// Frames of the simulated room from poses of the test's choice.
#pragma once

#include <opencv2/core.hpp>

#include "depth_fusion/frames/rgbd_frame.h"
#include "tools/simulation/simulated_recording.h"

namespace depth_fusion {

inline Pose motionOf(const Eigen::Vector3d& rotation_deg, const Eigen::Vector3d& translation_m) {
  Vector6d twist;
  twist << rotation_deg * (3.141592653589793 / 180.0), translation_m;
  return poseFromTwist(twist);
}

// Returns a pose within the room that sees furniture.
inline Pose roomPose() {
  SimulationOptions options;
  return SimulatedRecording(options).poseOf(60).T_W_D;
}

inline RgbdFrame frameOf(const RenderedView& view, const SensorModel& sensor, const CameraIntrinsics& camera,
                         uint64_t seed, double color_noise = 2.0) {
  RgbdFrame frame;
  frame.intrinsics = camera;
  frame.depth = senseDepth(view, sensor, seed);
  cv::Mat noise(view.color.size(), CV_16SC3), noisy;
  cv::RNG(seed + 77).fill(noise, cv::RNG::NORMAL, 0.0, color_noise);
  cv::add(view.color, noise, noisy, cv::noArray(), CV_8U);
  frame.color = noisy;
  return frame;
}

}  // namespace depth_fusion
