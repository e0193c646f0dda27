#include "openni2/driver/simulated_device.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <opencv2/imgproc.hpp>

#include "depth_fusion/recording/recording.h"

namespace depth_fusion {
namespace {

std::vector<RgbdFrame> readFrames(const std::string& folder) {
  const auto recording = openFolder(folder + "/recording", {});
  std::vector<RgbdFrame> frames;
  while (auto frame = recording->next()) {
    frame->depth.convertTo(frame->depth, CV_16U, 1e3 * frame->depth_unit_m);
    cv::cvtColor(frame->color, frame->color, cv::COLOR_BGR2RGB);
    frames.push_back(*frame);
  }
  return frames;
}

}  // namespace

SimulatedDevice::SimulatedDevice(std::string folder, std::string serial)
    : folder_(std::move(folder)), serial_(std::move(serial)), frames_(readFrames(folder_)) {
  const int width = frames_.front().depth.cols, height = frames_.front().depth.rows;
  depth_modes_ = {{ONI_PIXEL_FORMAT_SHIFT_9_2, width, height, 30},
                  {ONI_PIXEL_FORMAT_DEPTH_1_MM, width, height, 30}};
  color_modes_ = {{ONI_PIXEL_FORMAT_YUV422, width, height, 30}, {ONI_PIXEL_FORMAT_RGB888, width, height, 30}};
  ir_modes_ = {{ONI_PIXEL_FORMAT_GRAY16, width, height, 30}};
  sensors_ = {{ONI_SENSOR_DEPTH, static_cast<int>(depth_modes_.size()), depth_modes_.data()},
              {ONI_SENSOR_COLOR, static_cast<int>(color_modes_.size()), color_modes_.data()},
              {ONI_SENSOR_IR, static_cast<int>(ir_modes_.size()), ir_modes_.data()}};
  thread_ = std::thread([this] { run(); });
}

SimulatedDevice::~SimulatedDevice() {
  stopping_ = true;
  thread_.join();
}

OniStatus SimulatedDevice::getSensorInfoList(OniSensorInfo** sensors, int* count) {
  *sensors = sensors_.data();
  *count = static_cast<int>(sensors_.size());
  return ONI_STATUS_OK;
}

oni::driver::StreamBase* SimulatedDevice::createStream(OniSensorType sensor) {
  const auto& modes = sensor == ONI_SENSOR_DEPTH   ? depth_modes_
                      : sensor == ONI_SENSOR_COLOR ? color_modes_
                                                   : ir_modes_;
  auto* stream = new SimulatedStream(sensor, frames_.front().intrinsics, modes, folder_);
  const std::lock_guard<std::mutex> lock(mutex_);
  streams_.insert(stream);
  return stream;
}

void SimulatedDevice::destroyStream(oni::driver::StreamBase* stream) {
  const std::lock_guard<std::mutex> lock(mutex_);
  streams_.erase(static_cast<SimulatedStream*>(stream));
  delete stream;
}

OniBool SimulatedDevice::isPropertySupported(int id) {
  return id == ONI_DEVICE_PROPERTY_SERIAL_NUMBER || id == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION;
}

OniBool SimulatedDevice::isImageRegistrationModeSupported(OniImageRegistrationMode mode) {
  return mode == ONI_IMAGE_REGISTRATION_OFF || readControl(folder_).registers;
}

OniStatus SimulatedDevice::getProperty(int id, void* data, int* size) {
  if (id == ONI_DEVICE_PROPERTY_SERIAL_NUMBER && *size > static_cast<int>(serial_.size())) {
    std::memcpy(data, serial_.c_str(), serial_.size() + 1);
    *size = static_cast<int>(serial_.size() + 1);
    return ONI_STATUS_OK;
  }
  if (id != ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION) return ONI_STATUS_NOT_SUPPORTED;
  std::memcpy(data, &registration_, sizeof(registration_));
  return ONI_STATUS_OK;
}

OniStatus SimulatedDevice::setProperty(int id, const void* data, int size) {
  if (id != ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION || size != sizeof(registration_))
    return ONI_STATUS_NOT_SUPPORTED;
  std::memcpy(&registration_, data, sizeof(registration_));
  return ONI_STATUS_OK;
}

void SimulatedDevice::run() {
  auto next = std::chrono::steady_clock::now();
  while (!stopping_) {
    const DeviceControl control = readControl(folder_);
    const int before = shown_.empty() ? -1 : shown_.back();
    // Where it was when it was unplugged, or one further.
    shown_.push_back(
        std::min({before < 0 ? control.at : before + 1, control.at, static_cast<int>(frames_.size()) - 1}));
    if (control.plugged && !control.silent) deliver(static_cast<int>(shown_.size()) - 1, control);
    next += std::chrono::microseconds(std::lround(1e6 / control.fps));
    std::this_thread::sleep_until(next);
  }
}

void SimulatedDevice::deliver(int tick, const DeviceControl& control) {
  if (control.drop > 0 && tick % control.drop != 0) return;
  const auto timeOf = [&](int t) { return static_cast<uint64_t>(std::llround(1e6 * (t + 1) / control.fps)); };
  const int color_tick = tick - static_cast<int>(std::lround(control.late_color_s * control.fps));
  const std::lock_guard<std::mutex> lock(mutex_);
  for (SimulatedStream* stream : streams_) {
    if (stream->sensor() != ONI_SENSOR_COLOR)
      stream->deliver(frameOf(tick).depth, tick + 1, timeOf(tick), control.writes_addresses);
  }
  for (SimulatedStream* stream : streams_) {  // colour comes after its depth
    if (stream->sensor() == ONI_SENSOR_COLOR && color_tick >= 0)
      stream->deliver(frameOf(color_tick).color, color_tick + 1, timeOf(color_tick),
                      control.writes_addresses);
  }
}

}  // namespace depth_fusion
