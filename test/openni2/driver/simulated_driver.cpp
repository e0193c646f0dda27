// A driver for OpenNI2: cameras that show a recording, and do wrong what a test tells them to.
#define XN_NEW(Type, ...) new Type(__VA_ARGS__)
#define XN_DELETE(pointer) delete (pointer)
#include <cstdlib>
#include <cstring>

#include "openni2/driver/simulated_device.h"

namespace depth_fusion {
namespace {

constexpr auto kWatchPeriod = std::chrono::milliseconds(10);

OniDeviceInfo makeInfo(const char* uri) {
  OniDeviceInfo info{};
  std::strncpy(info.uri, uri, sizeof(info.uri) - 1);
  std::strcpy(info.vendor, "depth_fusion");
  std::strcpy(info.name, "Simulated");
  return info;
}

class SimulatedDriver : public oni::driver::DriverBase {
 public:
  explicit SimulatedDriver(OniDriverServices* services) : DriverBase(services) {}

  OniStatus initialize(oni::driver::DeviceConnectedCallback connected,
                       oni::driver::DeviceDisconnectedCallback disconnected,
                       oni::driver::DeviceStateChangedCallback changed, void* cookie) override {
    DriverBase::initialize(connected, disconnected, changed, cookie);
    const char* folder = std::getenv(kTestDeviceVariable);
    if (folder == nullptr) return ONI_STATUS_OK;
    folder_ = folder;
    watch();
    thread_ = std::thread([this] {
      for (; !stopping_; std::this_thread::sleep_for(kWatchPeriod)) watch();
    });
    return ONI_STATUS_OK;
  }

  void shutdown() override {
    stopping_ = true;
    if (thread_.joinable()) thread_.join();
  }

  oni::driver::DeviceBase* deviceOpen(const char* uri, const char*) override {
    return new SimulatedDevice(folder_, std::strcmp(uri, kFirstUri) == 0 ? kFirstSerial : kSecondSerial);
  }
  void deviceClose(oni::driver::DeviceBase* device) override { delete device; }

  void* enableFrameSync(oni::driver::StreamBase**, int) override { return this; }

 private:
  void watch() {
    const DeviceControl control = readControl(folder_);
    plug(kFirstUri, first_, control.plugged);
    plug(kSecondUri, second_, control.second);
  }

  void plug(const char* uri, bool& is_plugged, bool wanted) {
    if (is_plugged == wanted) return;
    is_plugged = wanted;
    const OniDeviceInfo info = makeInfo(uri);
    if (wanted) {
      deviceConnected(&info);
    } else {
      deviceDisconnected(&info);
    }
  }

  std::string folder_;
  bool first_ = false, second_ = false;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace
}  // namespace depth_fusion

ONI_EXPORT_DRIVER(depth_fusion::SimulatedDriver)
