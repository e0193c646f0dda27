// A device that shows a recording.
#pragma once

#include <set>
#include <string>
#include <thread>

#include "depth_fusion/frames/rgbd_frame.h"
#include "openni2/driver/simulated_stream.h"

namespace depth_fusion {

class SimulatedDevice : public oni::driver::DeviceBase {
 public:
  SimulatedDevice(std::string folder, std::string serial);
  ~SimulatedDevice() override;

  OniStatus getSensorInfoList(OniSensorInfo** sensors, int* count) override;
  oni::driver::StreamBase* createStream(OniSensorType sensor) override;
  void destroyStream(oni::driver::StreamBase* stream) override;
  OniStatus getProperty(int id, void* data, int* size) override;
  OniStatus setProperty(int id, const void* data, int size) override;
  OniBool isPropertySupported(int id) override;
  OniBool isImageRegistrationModeSupported(OniImageRegistrationMode mode) override;

 private:
  void run();
  void deliver(int tick, const DeviceControl& control);
  const RgbdFrame& frameOf(int tick) const {
    return frames_[static_cast<size_t>(shown_[static_cast<size_t>(tick)])];
  }

  const std::string folder_, serial_;
  std::vector<RgbdFrame> frames_;  // depth in millimetres, colour as RGB
  std::vector<OniVideoMode> depth_modes_, color_modes_, ir_modes_;
  std::vector<OniSensorInfo> sensors_;
  std::vector<int> shown_;  // the frame of each tick so far
  OniImageRegistrationMode registration_ = ONI_IMAGE_REGISTRATION_OFF;
  std::mutex mutex_;
  std::set<SimulatedStream*> streams_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace depth_fusion
