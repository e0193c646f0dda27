#include "ros/input/device_publisher.h"

#include <algorithm>
#include <cmath>

#include "depth_fusion/common/error.h"
#include "ros/conversions/messages.h"
#include "ros/input/device_messages.h"

namespace depth_fusion {
namespace {

using diagnostic_msgs::DiagnosticStatus;

constexpr double kRetry_s = 0.5;
constexpr double kWait_s = 0.1;

}  // namespace

DevicePublisher::DevicePublisher(const SourceHost& host, const DevicePublisherParameters& parameters)
    : FrameSource(host),
      given_(parameters),
      parameters_(parameters),
      cameras_(host_.handle, parameters_.rgb_camera_info_url, parameters_.depth_camera_info_url) {
  requireDevices();
  depth_ = advertise("depth");
  if (parameters_.device.color_mode != "off") color_ = advertise("rgb");
  if (parameters_.device.ir_mode != "off") ir_ = advertise("ir");
}

DevicePublisher::Output DevicePublisher::advertise(const std::string& name) {
  ros::NodeHandle handle = host_.handle;
  return {handle.advertise<sensor_msgs::Image>(name + "/image", 10),
          handle.advertise<sensor_msgs::CameraInfo>(name + "/camera_info", 10)};
}

void DevicePublisher::applyParameters() {
  const std::lock_guard<std::mutex> lock(mutex_);
  parameters_.device.camera = given_.device.camera;
  parameters_.time = given_.time;
  settings_changed_ = true;
}

void DevicePublisher::run() {
  while (sleep(0.0)) {
    try {
      if (device_ == nullptr) open();
      if (device_->await(kWait_s)) publishNext();
      applySettings();
    } catch (const std::exception& error) {
      close();
      setState(DiagnosticStatus::ERROR, error.what());
      sleep(kRetry_s);
    }
  }
}

void DevicePublisher::open() {
  DeviceParameters wanted;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    wanted = parameters_.device;
    settings_changed_ = false;
  }
  device_ = openDevice(wanted);
  cameras_.setDevice(device_->serial());
  clock_ = {};
  color_delay_.restart();
  ROS_INFO_STREAM(host_.name << ": " << device_->name() << ", serial number " << device_->serial());
  showState();
  const std::lock_guard<std::mutex> lock(mutex_);
  device_name_ = device_->name();
}

void DevicePublisher::close() {
  device_.reset();
  const std::lock_guard<std::mutex> lock(mutex_);
  device_name_ = "none";
}

void DevicePublisher::applySettings() {
  CameraSettings settings;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!settings_changed_) return;
    settings_changed_ = false;
    settings = parameters_.device.camera;
  }
  try {
    device_->apply(settings);
  } catch (const Error& error) {
    ROS_WARN_STREAM(host_.name << ": " << error.what());
  }
}

void DevicePublisher::publishNext() {
  StageTimers timers;
  {
    const StageTimers::Scope timer(timers, "acquisition");
    DeviceImage image = device_->read();
    count(image);
    const double stamp_s = stampOf(image);
    noteDelay(image.stream, stamp_s);
    const auto info = boost::make_shared<sensor_msgs::CameraInfo>(infoOf(image));
    info->header = makeHeader(toRosTime(stamp_s), isSeenByColor(image.stream) ? parameters_.rgb_frame_id
                                                                              : parameters_.depth_frame_id);
    const Output& output = outputOf(image.stream);
    output.info.publish(info);
    output.image.publish(toMessage(std::move(image), info->header, device_->buffers()));
  }
  host_.record_timings(timers);
}

void DevicePublisher::count(const DeviceImage& image) {
  if (image.stream != ImageStream::kDepth) return;
  for (int i = 0; i < image.missed; ++i) {
    host_.counter.receive();
    host_.counter.drop("missed by the camera or its driver");
  }
  host_.counter.receive();
  host_.counter.process();
}

double DevicePublisher::stampOf(const DeviceImage& image) {
  const double now_s = ros::Time::now().toSec();
  const double device_s = clock_.toHost(image.device_time_s, now_s);
  const std::lock_guard<std::mutex> lock(mutex_);
  const DeviceTimeParameters& time = parameters_.time;
  const double offset_s = image.stream == ImageStream::kDepth   ? time.depth_time_offset
                          : image.stream == ImageStream::kColor ? time.color_time_offset
                                                                : time.ir_time_offset;
  return std::max(0.0, (time.use_device_time ? device_s : now_s) + offset_s);
}

void DevicePublisher::noteDelay(ImageStream stream, double stamp_s) {
  const bool was_late = color_delay_.isLate();
  color_delay_.note(stream, stamp_s);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    color_delay_s_ = color_delay_.delay_s();
  }
  if (color_delay_.isLate() != was_late) showState();
}

void DevicePublisher::showState() {
  std::string text;
  const auto add = [&](const std::string& problem) { text += (text.empty() ? "" : "; ") + problem; };
  for (const std::string& shortcoming : device_->shortcomings()) add(shortcoming);
  if (color_delay_.isLate())
    add(device_->name() +
        " delivers colour too late for its depth: fusion goes on without colour; ask for fewer pixels with "
        "color_mode, or give color_depth_synchronization");
  setState(text.empty() ? DiagnosticStatus::OK : DiagnosticStatus::WARN, text);
}

bool DevicePublisher::isSeenByColor(ImageStream stream) const {
  return stream == ImageStream::kColor || (stream == ImageStream::kDepth && device_->registersDepth());
}

sensor_msgs::CameraInfo DevicePublisher::infoOf(const DeviceImage& image) {
  if (!isSeenByColor(image.stream))
    return cameras_.depthInfo(image.width, image.height, device_->fieldOfView_rad(ImageStream::kDepth));
  const double angle_rad = device_->fieldOfView_rad(ImageStream::kColor);
  return cameras_.colorInfo(image.width, image.height,
                            angle_rad > 0.0 ? angle_rad : device_->fieldOfView_rad(image.stream));
}

const DevicePublisher::Output& DevicePublisher::outputOf(ImageStream stream) const {
  return stream == ImageStream::kDepth ? depth_ : stream == ImageStream::kColor ? color_ : ir_;
}

void DevicePublisher::addValues(diagnostic_updater::DiagnosticStatusWrapper& status) {
  status.add("camera", device_name_);
  status.add("colour after depth ms", std::lround(1e3 * color_delay_s_));
}

}  // namespace depth_fusion
