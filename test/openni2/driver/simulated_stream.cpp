#include "openni2/driver/simulated_stream.h"

#include <cmath>
#include <cstring>

namespace depth_fusion {
namespace {

template <class Value>
OniStatus give(const Value& value, void* data, int* size) {
  if (*size != static_cast<int>(sizeof(Value))) return ONI_STATUS_BAD_PARAMETER;
  std::memcpy(data, &value, sizeof(Value));
  return ONI_STATUS_OK;
}

bool sameMode(const OniVideoMode& a, const OniVideoMode& b) {
  return a.pixelFormat == b.pixelFormat && a.resolutionX == b.resolutionX && a.resolutionY == b.resolutionY &&
         a.fps == b.fps;
}

}  // namespace

SimulatedStream::SimulatedStream(OniSensorType sensor, const CameraIntrinsics& camera,
                                 const std::vector<OniVideoMode>& modes, std::string folder)
    : sensor_(sensor), camera_(camera), modes_(modes), folder_(std::move(folder)), mode_(modes.back()) {}

OniStatus SimulatedStream::start() {
  const std::lock_guard<std::mutex> lock(mutex_);
  started_ = true;
  return ONI_STATUS_OK;
}

void SimulatedStream::stop() {
  const std::lock_guard<std::mutex> lock(mutex_);
  started_ = false;
}

void SimulatedStream::deliver(const cv::Mat& pixels, int index, uint64_t timestamp_us, bool writes_address) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!started_) return;
  OniFrame* frame = getServices().acquireFrame();
  if (frame == nullptr) return;
  frame->sensorType = sensor_;
  frame->timestamp = timestamp_us;
  frame->frameIndex = index;
  frame->videoMode = mode_;
  frame->width = pixels.cols;
  frame->height = pixels.rows;
  frame->stride = static_cast<int>(pixels.cols * pixels.elemSize());
  frame->dataSize = frame->stride * frame->height;
  frame->croppingEnabled = FALSE;
  frame->cropOriginX = frame->cropOriginY = 0;
  cv::Mat target(pixels.size(), pixels.type(), frame->data);
  if (mirrored_) {
    cv::flip(pixels, target, 1);
  } else {
    pixels.copyTo(target);
  }
  if (writes_address) std::memcpy(frame->data, &frame->data, sizeof(frame->data));
  raiseNewFrame(frame);
  getServices().releaseFrame(frame);
}

OniBool SimulatedStream::isPropertySupported(int id) {
  return id <= ONI_STREAM_PROPERTY_MIN_VALUE || id == ONI_STREAM_PROPERTY_MIRRORING ||
         settingOf(id) != nullptr;
}

int* SimulatedStream::settingOf(int id) {
  if (sensor_ != ONI_SENSOR_COLOR) return nullptr;
  switch (id) {
    case ONI_STREAM_PROPERTY_AUTO_EXPOSURE:
      return &settings_.auto_exposure;
    case ONI_STREAM_PROPERTY_AUTO_WHITE_BALANCE:
      return &settings_.auto_white_balance;
    case ONI_STREAM_PROPERTY_EXPOSURE:
      return &settings_.exposure;
    case ONI_STREAM_PROPERTY_GAIN:
      return &settings_.gain;
    default:
      return nullptr;
  }
}

OniStatus SimulatedStream::getProperty(int id, void* data, int* size) {
  if (const int* setting = settingOf(id)) return give(*setting, data, size);
  switch (id) {
    case ONI_STREAM_PROPERTY_VIDEO_MODE:
      return give(mode_, data, size);
    case ONI_STREAM_PROPERTY_MIRRORING:
      return give(mirrored_, data, size);
    case ONI_STREAM_PROPERTY_HORIZONTAL_FOV:
      return give(static_cast<float>(2.0 * std::atan(0.5 * camera_.width / camera_.fx)), data, size);
    case ONI_STREAM_PROPERTY_VERTICAL_FOV:
      return give(static_cast<float>(2.0 * std::atan(0.5 * camera_.height / camera_.fy)), data, size);
    case ONI_STREAM_PROPERTY_MAX_VALUE:
      return give(10000, data, size);
    case ONI_STREAM_PROPERTY_MIN_VALUE:
      return give(0, data, size);
    case ONI_STREAM_PROPERTY_CROPPING:
      return give(OniCropping{}, data, size);
    default:
      return ONI_STATUS_NOT_SUPPORTED;
  }
}

OniStatus SimulatedStream::setProperty(int id, const void* data, int size) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (int* setting = settingOf(id)) {
    std::memcpy(setting, data, sizeof(*setting));
    std::ofstream(settingsPath(folder_)) << settings_.auto_exposure << ' ' << settings_.auto_white_balance
                                         << ' ' << settings_.exposure << ' ' << settings_.gain;
    return ONI_STATUS_OK;
  }
  if (id == ONI_STREAM_PROPERTY_MIRRORING && size == sizeof(mirrored_)) {
    std::memcpy(&mirrored_, data, sizeof(mirrored_));
    return ONI_STATUS_OK;
  }
  if (id != ONI_STREAM_PROPERTY_VIDEO_MODE || size != sizeof(mode_)) return ONI_STATUS_NOT_SUPPORTED;
  if (readControl(folder_).refuses_modes) return ONI_STATUS_ERROR;
  OniVideoMode wanted;
  std::memcpy(&wanted, data, sizeof(wanted));
  for (const OniVideoMode& mode : modes_) {
    if (!sameMode(mode, wanted)) continue;
    mode_ = mode;
    return ONI_STATUS_OK;
  }
  return ONI_STATUS_NOT_SUPPORTED;
}

}  // namespace depth_fusion
