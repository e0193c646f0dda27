// A stream of the simulated device.
#pragma once

#include <Driver/OniDriverAPI.h>
#include <OniCTypes.h>

#include <atomic>
#include <functional>
#include <mutex>
#include <opencv2/core.hpp>
#include <vector>

#include "depth_fusion/geometry/camera_intrinsics.h"
#include "openni2/driver/control.h"

namespace depth_fusion {

struct ColorSettings {
  int auto_exposure = 1, auto_white_balance = 1, exposure = 0, gain = 0;
};

class SimulatedStream : public oni::driver::StreamBase {
 public:
  SimulatedStream(OniSensorType sensor, const CameraIntrinsics& camera,
                  const std::vector<OniVideoMode>& modes, std::string folder);

  OniStatus start() override;
  void stop() override;
  OniStatus getProperty(int id, void* data, int* size) override;
  OniStatus setProperty(int id, const void* data, int size) override;
  OniBool isPropertySupported(int id) override;

  OniSensorType sensor() const { return sensor_; }
  // If it is started. Unmirrored pixels as the mode has them.
  void deliver(const cv::Mat& pixels, int index, uint64_t timestamp_us, bool writes_address);

 private:
  int* settingOf(int id);

  const OniSensorType sensor_;
  const CameraIntrinsics camera_;
  const std::vector<OniVideoMode> modes_;
  const std::string folder_;
  std::mutex mutex_;
  bool started_ = false;
  OniVideoMode mode_;
  OniBool mirrored_ = TRUE;
  ColorSettings settings_;
};

}  // namespace depth_fusion
