// Messages of depth and colour as frames for the stages.
#pragma once

#include <string>

#include "ros/in_process/frames.h"
#include "ros/input/lazy_registration.h"
#include "ros/input/rgbd_pairing.h"
#include "ros/input/sensor_cameras.h"

namespace depth_fusion {

// For one thread, but for cameras() and knowsCameras().
class RgbdDecoder {
 public:
  // device: as ComputeContext has it; opened if a frame needs it.
  RgbdDecoder(const ros::NodeHandle& handle, const std::string& device)
      : cameras_(handle), registration_(device) {}

  // Decodes the images or the cloud, and registers them: without lens distortion, and with the way from the
  // depth camera to the colour camera, which tf says where their frames differ. What is wrong with colour
  // leaves colour out and is the frame's color_problem. What a mask shows has no depth. Throws Error for
  // depth or a mask that cannot be used.
  SensorFramePtr decode(const RgbdMessages& messages, const RegistrationParameters& registration);

  // What is needed to decode them is here: organised clouds tell their camera themselves.
  bool knowsCameras(const RgbdMessages& messages) {
    const auto& cloud = messages.depth.cloud;
    return (cloud != nullptr && isOrganised(*cloud)) || cameras_.areKnown(messages.header);
  }
  const SensorCameras& cameras() const { return cameras_; }

 private:
  // Sets depth, colour and intrinsics by the cloud, or of a list of points by the camera_info.
  void takeCloud(const RgbdMessages& messages, SensorFrame& frame);

  SensorCameras cameras_;
  CameraIntrinsics cloud_camera_;  // of the organised clouds
  LazyRegistration registration_;
};

}  // namespace depth_fusion
