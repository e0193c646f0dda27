// Messages of depth and colour as frames for the stages.
#pragma once

#include <string>

#include "ros/in_process/frames.h"
#include "ros/input/lazy_registration.h"
#include "ros/input/rgbd_pairing.h"
#include "ros/input/sensor_cameras.h"

namespace depth_fusion {

// For one thread, but for cameras().
class RgbdDecoder {
 public:
  // device: as ComputeContext has it; opened if a frame needs it.
  RgbdDecoder(const ros::NodeHandle& handle, const std::string& device)
      : cameras_(handle), registration_(device) {}

  // Decodes the images, and registers them: without lens distortion, and with the way from the depth camera
  // to the colour camera, which tf says where their frames differ. What is wrong with colour leaves colour
  // out and is the frame's color_problem. Throws Error for depth that cannot be used.
  SensorFramePtr decode(const RgbdMessages& messages, const RegistrationParameters& registration);

  SensorCameras& cameras() { return cameras_; }
  const SensorCameras& cameras() const { return cameras_; }

 private:
  SensorCameras cameras_;
  LazyRegistration registration_;
};

}  // namespace depth_fusion
