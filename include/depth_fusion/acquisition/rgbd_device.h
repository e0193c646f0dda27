// A camera that OpenNI2 has a driver for: Xtion, PrimeSense; with their makers' drivers Kinect, Astra, ...
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "depth_fusion/acquisition/device_parameters.h"
#include "depth_fusion/acquisition/frame_buffers.h"

namespace depth_fusion {

enum class ImageStream { kDepth, kColor, kInfrared };

struct DeviceImage {
  ImageStream stream = ImageStream::kDepth;
  int width = 0;
  int height = 0;
  size_t step = 0;             // bytes a row
  std::string encoding;        // ROS's name: 16UC1, rgb8, mono8, mono16
  double depth_unit_m = 0.0;   // of depth
  double device_time_s = 0.0;  // by the device's clock
  int missed = 0;              // images of the stream between the last one and this
  std::vector<uint8_t> pixels;
};

class RgbdDevice {
 public:
  virtual ~RgbdDevice() = default;

  // Waits until there is an image of any stream; gives up and returns false after the given time. Throws
  // Error if the device is unplugged or has fallen silent; it is then of no more use.
  virtual bool await(double timeout_s) = 0;
  // The image that await() has found.
  virtual DeviceImage read() = 0;

  // Where the images' pixels go back to when they have been read.
  virtual std::shared_ptr<FrameBuffers> buffers() const = 0;

  // Names driver and place in one line, for the user.
  virtual std::string name() const = 0;
  // The device's serial number, or its URI where it has none.
  virtual std::string serial() const = 0;
  // True if depth comes as the colour camera sees it.
  virtual bool registersDepth() const = 0;
  // The horizontal field of view in radians; 0 if the driver does not know it.
  virtual double fieldOfView_rad(ImageStream stream) const = 0;
  // Says what was asked for and cannot be had, a line each.
  virtual std::vector<std::string> shortcomings() const = 0;

  // Throws Error naming what the device refuses.
  virtual void apply(const CameraSettings& settings) = 0;
};

// Throws Error, saying what to install, if this build has no OpenNI2.
void requireDevices();

// Opens the device of that URI, serial number, "#n" (the n-th, from 1), "bus@n" (the USB address; n = 0: any
// on the bus) or "" (the first). Throws Error naming the devices that there are, or the modes of the device,
// if there is none such.
std::unique_ptr<RgbdDevice> openDevice(const DeviceParameters& parameters);

}  // namespace depth_fusion
