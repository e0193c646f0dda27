#include <OpenNI.h>

#include <chrono>

#include "acquisition/openni2/openni2_thread.h"
#include "acquisition/openni2/runtime.h"
#include "acquisition/openni2/stream.h"
#include "depth_fusion/acquisition/rgbd_device.h"
#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kMaxSilence{5};
constexpr double kSlice_s = 0.005;

class OpenNi2Device : public RgbdDevice {
 public:
  explicit OpenNi2Device(const DeviceParameters& parameters) : uri_(findDevice(parameters.device_id)) {
    check(device_.open(uri_.c_str()) == openni::STATUS_OK, uri_ + " cannot be opened: " + openNi2Error());
    const openni::DeviceInfo& info = device_.getDeviceInfo();
    name_ = std::string(info.getVendor()) + " " + info.getName() + " (" + uri_ + ")";
    serial_ = serialOf(device_);
    addStream(ImageStream::kDepth, "depth_mode", parameters.depth_mode);
    addStream(ImageStream::kColor, "color_mode", parameters.color_mode);
    addStream(ImageStream::kInfrared, "ir_mode", parameters.ir_mode);
    setRegistration(parameters.depth_registration);
    for (const auto& stream : streams_) stream->start();
    synchronise(parameters.color_depth_synchronization);
    try {
      apply(parameters.camera);
    } catch (const Error& error) {
      shortcomings_.push_back(error.what());
    }
  }

  bool await(double timeout_s) override {
    std::vector<openni::VideoStream*> videos;
    for (const auto& stream : streams_) videos.push_back(&stream->video());
    const openni::Status status = openni::OpenNI::waitForAnyStream(
        videos.data(), static_cast<int>(videos.size()), &ready_, static_cast<int>(1e3 * timeout_s));
    if (status == openni::STATUS_OK) {
      last_image_ = Clock::now();
      return true;
    }
    check(isPlugged(uri_), name_ + " was unplugged; plug it in again and it goes on");
    check(status == openni::STATUS_TIME_OUT, name_ + " gives no images: " + openNi2Error());
    check(Clock::now() - last_image_ < kMaxSilence, name_ + " sends nothing any more; it is opened anew");
    return false;
  }

  DeviceImage read() override { return streams_[static_cast<size_t>(ready_)]->read(); }

  std::shared_ptr<FrameBuffers> buffers() const override { return buffers_; }
  std::string name() const override { return name_; }
  std::string serial() const override { return serial_.empty() ? uri_ : serial_; }
  bool registersDepth() const override { return registers_depth_; }
  std::vector<std::string> shortcomings() const override { return shortcomings_; }

  double fieldOfView_rad(ImageStream kind) const override {
    for (const auto& stream : streams_) {
      if (stream->kind() == kind) return stream->video().getHorizontalFieldOfView();
    }
    return 0.0;
  }

  void apply(const CameraSettings& settings) override {
    for (const auto& stream : streams_) {
      if (stream->kind() == ImageStream::kColor) applyTo(stream->video().getCameraSettings(), settings);
    }
  }

 private:
  void addStream(ImageStream kind, const std::string& parameter, const std::string& mode) {
    if (mode == "off") {
      check(kind != ImageStream::kDepth, parameter + " cannot be off");
      return;
    }
    streams_.push_back(std::make_unique<OpenNi2Stream>(device_, kind, parseVideoMode(mode, parameter), name_,
                                                       std::make_unique<BufferAllocator>(buffers_)));
  }

  void setRegistration(bool wanted) {
    const auto mode = wanted ? openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR : openni::IMAGE_REGISTRATION_OFF;
    registers_depth_ = device_.isImageRegistrationModeSupported(mode) &&
                       device_.setImageRegistrationMode(mode) == openni::STATUS_OK && wanted;
    if (wanted && !registers_depth_) shortcomings_.push_back(name_ + " cannot register depth to colour");
  }

  void synchronise(bool wanted) {
    if (device_.setDepthColorSyncEnabled(wanted) != openni::STATUS_OK && wanted)
      shortcomings_.push_back(name_ + " cannot synchronise depth and colour");
  }

  void applyTo(openni::CameraSettings* camera, const CameraSettings& settings) const {
    const bool is_default = settings.auto_exposure && settings.auto_white_balance;
    if (camera == nullptr && is_default) return;
    check(camera != nullptr, name_ + " has no settings of exposure and white balance");
    const auto set = [&](openni::Status status, const std::string& setting) {
      check(status == openni::STATUS_OK, name_ + " refuses " + setting + ": " + openNi2Error());
    };
    set(camera->setAutoExposureEnabled(settings.auto_exposure), "auto_exposure");
    set(camera->setAutoWhiteBalanceEnabled(settings.auto_white_balance), "auto_white_balance");
    if (settings.auto_exposure) return;
    if (settings.exposure > 0)
      set(camera->setExposure(settings.exposure), "exposure " + std::to_string(settings.exposure));
    if (settings.gain > 0) set(camera->setGain(settings.gain), "gain " + std::to_string(settings.gain));
  }

  const OpenNi2Runtime runtime_;
  const std::string uri_;
  std::string name_, serial_;
  std::shared_ptr<FrameBuffers> buffers_ = std::make_shared<FrameBuffers>();
  openni::Device device_;
  std::vector<std::unique_ptr<OpenNi2Stream>> streams_;
  int ready_ = 0;  // the stream that has an image
  bool registers_depth_ = false;
  std::vector<std::string> shortcomings_;
  Clock::time_point last_image_ = Clock::now();
};

// A device for callers in any thread.
class DeviceInOneThread : public RgbdDevice {
 public:
  explicit DeviceInOneThread(const DeviceParameters& parameters)
      : device_(inOpenNi2Thread([&] { return std::make_unique<OpenNi2Device>(parameters); })) {}
  ~DeviceInOneThread() override {
    inOpenNi2Thread([this] { device_.reset(); });
  }

  // Waits in slices, for other devices have the same thread.
  bool await(double timeout_s) override {
    for (const auto end = Clock::now() + std::chrono::duration<double>(timeout_s); Clock::now() < end;) {
      if (inOpenNi2Thread([this] { return device_->await(kSlice_s); })) return true;
    }
    return false;
  }
  DeviceImage read() override {
    return inOpenNi2Thread([this] { return device_->read(); });
  }
  double fieldOfView_rad(ImageStream kind) const override {
    return inOpenNi2Thread([&] { return device_->fieldOfView_rad(kind); });
  }
  void apply(const CameraSettings& settings) override {
    inOpenNi2Thread([&] { device_->apply(settings); });
  }
  std::shared_ptr<FrameBuffers> buffers() const override { return device_->buffers(); }
  std::string name() const override { return device_->name(); }
  std::string serial() const override { return device_->serial(); }
  bool registersDepth() const override { return device_->registersDepth(); }
  std::vector<std::string> shortcomings() const override { return device_->shortcomings(); }

 private:
  std::unique_ptr<OpenNi2Device> device_;
};

}  // namespace

void requireDevices() {}

std::unique_ptr<RgbdDevice> openDevice(const DeviceParameters& parameters) {
  return std::make_unique<DeviceInOneThread>(parameters);
}

}  // namespace depth_fusion
