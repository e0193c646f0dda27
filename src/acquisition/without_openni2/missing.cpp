// This file stands in for src/acquisition/openni2/ where the library was not found at build.
#include "depth_fusion/acquisition/oni_recording.h"
#include "depth_fusion/acquisition/rgbd_device.h"
#include "depth_fusion/common/error.h"

namespace depth_fusion {

void requireDevices() {
  throw Error(
      "this build has no OpenNI2, which reads cameras and .oni files: install libopenni2-dev and build "
      "again, or "
      "start the camera's own driver and reconstruction.launch");
}

std::unique_ptr<RgbdDevice> openDevice(const DeviceParameters&) {
  requireDevices();
  return nullptr;
}

std::unique_ptr<Recording> openOni(const std::string& path, const RecordingOptions&) {
  try {
    requireDevices();
  } catch (const Error& error) {
    throw Error(path + ": " + error.what());
  }
  return nullptr;
}

}  // namespace depth_fusion
