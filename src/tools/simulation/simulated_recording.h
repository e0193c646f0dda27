// A built-in scene seen by a simulated hand-held sensor, as a recording with exact poses.
#pragma once

#include <optional>

#include "depth_fusion/recording/recording.h"
#include "tools/simulation/scene_library.h"
#include "tools/simulation/simulated_robot.h"

namespace depth_fusion {

struct SimulationOptions {
  std::string scene = "room";
  std::string walk;  // one of the scene's walks; empty: the first
  int frames = 300;
  bool noise = true;
  bool lifelike = false;  // rolling shutter, and a colour camera with noise, exposure and motion blur
  double tremor = 1.0;    // of the hand, times its own
  unsigned seed = 1;
  double fps = 30.0;
  double speed = 1.0;  // times the scene's own
  // The speed of the recording's fastest moment, tremor aside, in place of `speed`; 0: as `speed` says.
  double linear_speed_m_s = 0.0;
  double turn_rate_deg_s = 0.0;
  RobotOptions robot;           // what is under the camera
  CameraIntrinsics intrinsics;  // width 0: those of the scene's sensor
};

class SimulatedRecording : public Recording {
 public:
  // Throws Error for an unknown scene or a value that makes no sense.
  explicit SimulatedRecording(const SimulationOptions& options);

  // Frames have depth as CV_32FC1 in metres, colour as BGR and the exact pose. The same options give the same
  // bits.
  std::optional<RgbdFrame> next() override;
  size_t frameCount() const override { return static_cast<size_t>(options_.frames); }
  std::string description() const override;

  const SimulatedScene& scene() const { return scene_; }
  StampedPose poseOf(int frame) const {
    return {kFirstStamp_s + frame / options_.fps, poseAt(frame / options_.fps)};
  }
  const CameraIntrinsics& intrinsics() const { return options_.intrinsics; }

 private:
  static constexpr double kFirstStamp_s = 1.0;  // ROS does not record a time of zero

  Pose poseAt(double time_s) const;
  // Renders what is read until the time.
  RenderedView viewAt(double time_s) const;

  SimulationOptions options_;
  SimulatedScene scene_;
  HandSpeed hand_speed_;
  std::optional<SimulatedRobot> robot_;
  int next_frame_ = 0;
};

}  // namespace depth_fusion
