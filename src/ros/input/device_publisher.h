// Publishes the images of a camera, waits for it where it is not plugged in, and goes on when it is again.
#pragma once

#include <sensor_msgs/Image.h>

#include <memory>
#include <string>

#include "acquisition/device_clock.h"
#include "ros/input/color_delay.h"
#include "ros/input/device_cameras.h"
#include "ros/input/device_publisher_parameters.h"
#include "ros/input/frame_source.h"

namespace depth_fusion {

class DevicePublisher : public FrameSource {
 public:
  // The parameters are the nodelet's own. Throws Error if this build has no cameras.
  DevicePublisher(const SourceHost& host, const DevicePublisherParameters& parameters);

  void run() override;
  void applyParameters() override;

 private:
  struct Output {
    ros::Publisher image, info;
  };

  Output advertise(const std::string& name);
  void open();
  void close();
  void applySettings();
  void publishNext();
  void count(const DeviceImage& image);
  void noteDelay(ImageStream stream, double stamp_s);
  void showState();
  double stampOf(const DeviceImage& image);
  // Registered depth is what the colour camera sees.
  bool isSeenByColor(ImageStream stream) const;
  sensor_msgs::CameraInfo infoOf(const DeviceImage& image);
  const Output& outputOf(ImageStream stream) const;
  void addValues(diagnostic_updater::DiagnosticStatusWrapper& status) override;

  const DevicePublisherParameters& given_;
  DevicePublisherParameters parameters_;  // a copy; those that change live are guarded by the mutex
  bool settings_changed_ = false;         // guarded by the mutex
  std::string device_name_ = "none";      // guarded by the mutex
  double color_delay_s_ = 0.0;            // guarded by the mutex

  Output depth_, color_, ir_;
  DeviceCameras cameras_;
  std::unique_ptr<RgbdDevice> device_;
  DeviceClock clock_;
  ColorDelay color_delay_;
};

}  // namespace depth_fusion
