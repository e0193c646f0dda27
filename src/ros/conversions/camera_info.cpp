#include "ros/conversions/camera_info.h"

#include <algorithm>
#include <cstdint>
#include <set>

#include "common/lowered.h"
#include "depth_fusion/common/error.h"
#include "depth_fusion/geometry/camera_check.h"

namespace depth_fusion {
namespace {

constexpr char kCure[] =
    "; calibrate the camera (camera_calibration), or give its numbers (--camera, --intrinsics)";

// The part of the sensor that the images show, in pixels of the sensor, of which `binning` make one of the
// images'.
struct SensorWindow {
  cv::Rect region;
  cv::Size binning;

  cv::Size imageSize() const { return {region.width / binning.width, region.height / binning.height}; }
  bool isWhole(cv::Size sensor) const { return imageSize() == sensor; }
};

cv::Size sensorSize(const sensor_msgs::CameraInfo& info) {
  return {static_cast<int>(info.width), static_cast<int>(info.height)};
}

// A ROI without a size is the whole sensor, a binning of 0 is 1.
SensorWindow windowOf(const sensor_msgs::CameraInfo& info) {
  SensorWindow window{
      {{0, 0}, sensorSize(info)},
      {std::max(1, static_cast<int>(info.binning_x)), std::max(1, static_cast<int>(info.binning_y))}};
  const auto& roi = info.roi;
  if (roi.width > 0 && roi.height > 0)
    window.region = {static_cast<int>(roi.x_offset), static_cast<int>(roi.y_offset),
                     static_cast<int>(roi.width), static_cast<int>(roi.height)};
  return window;
}

CameraIntrinsics fromK(const sensor_msgs::CameraInfo& info, cv::Size sensor) {
  return {sensor.width, sensor.height, info.K[0], info.K[4], info.K[2], info.K[5]};
}

CameraIntrinsics fromP(const sensor_msgs::CameraInfo& info, cv::Size sensor) {
  return {sensor.width, sensor.height, info.P[0], info.P[5], info.P[2], info.P[6]};
}

// ROS scales the principal point with the pixels' indices, as image_geometry does.
CameraIntrinsics through(const SensorWindow& window, const CameraIntrinsics& sensor) {
  const cv::Size size = window.imageSize();
  const double x = window.binning.width, y = window.binning.height;
  return {size.width,
          size.height,
          sensor.fx / x,
          sensor.fy / y,
          (sensor.cx - window.region.x) / x,
          (sensor.cy - window.region.y) / y};
}

// Some word of the name, as in image_rect_color, begins so.
bool isRectified(const std::string& image_topic) {
  for (size_t at = image_topic.find("rect"); at != std::string::npos; at = image_topic.find("rect", at + 1)) {
    if (at == 0 || image_topic[at - 1] == '/' || image_topic[at - 1] == '_') return true;
  }
  return false;
}

// The model is empty in old bags.
LensDistortion lensOf(const sensor_msgs::CameraInfo& info, const std::string& info_topic) {
  static const std::set<std::string> kKnown = {"",       "plumb_bob",     "rational_polynomial",
                                               "radtan", "brown_conrady", "brown conrady"};
  static const std::set<std::string> kBendWithoutCoefficients = {"equidistant", "fisheye", "kannala_brandt",
                                                                 "kannala_brandt4", "omnidirectional"};
  const std::string model = lowered(info.distortion_model);
  if (!distorts(info.D) && kBendWithoutCoefficients.count(model) == 0) return {};
  check(kKnown.count(model) == 1,
        info_topic + ": the distortion model '" + info.distortion_model +
            "' is not known; plumb_bob and rational_polynomial are, images of others "
            "must be rectified before (image_proc)");
  try {
    checkDistortion(info.D);
  } catch (const Error& error) {
    throw Error(info_topic + ": " + error.what() + kCure);
  }
  return info.D;
}

// What counts first of K and P, and which of them it is.
struct Reading {
  CameraIntrinsics sensor;
  bool is_projection;
};

Reading chooseReading(const sensor_msgs::CameraInfo& info, cv::Size sensor, bool rectified,
                      const std::string& info_topic) {
  Reading first{fromK(info, sensor), false}, second{fromP(info, sensor), true};
  if (rectified) std::swap(first, second);
  const std::string problem = cameraProblem(first.sensor);
  if (problem.empty()) return first;
  const bool second_serves = cameraProblem(second.sensor).empty() && (rectified || !distorts(info.D));
  check(second_serves, info_topic + ": the intrinsics are not valid: " + problem + kCure);
  return second;
}

}  // namespace

CameraModel cameraFromInfo(const sensor_msgs::CameraInfo& info, const std::string& info_topic,
                           const std::string& image_topic, cv::Size image_size) {
  const bool rectified = isRectified(image_topic);
  sensor_msgs::CameraInfo sized = info;
  if (info.width == 0 && info.height == 0) {
    sized.width = static_cast<uint32_t>(image_size.width);
    sized.height = static_cast<uint32_t>(image_size.height);
  }
  const cv::Size sensor = sensorSize(sized);
  const SensorWindow window = windowOf(sized);
  const bool shows_sensor = image_size == sensor;
  check(shows_sensor || image_size == window.imageSize(),
        info_topic + ": it is for images of " +
            sizeText(window.imageSize().width, window.imageSize().height) +
            (window.isWhole(sensor)
                 ? ""
                 : " (by its binning and ROI, of " + sizeText(sensor.width, sensor.height) + ")") +
            ", those of " + image_topic + " are " + sizeText(image_size.width, image_size.height) +
            "; give the camera_info of these images, or their numbers (--camera, --intrinsics)");
  const Reading reading = chooseReading(sized, sensor, rectified, info_topic);
  CameraModel model;
  model.intrinsics = shows_sensor ? reading.sensor : through(window, reading.sensor);
  if (reading.is_projection != rectified)
    model.remark = info_topic + ": its " + (rectified ? "P is none, K" : "K is none, P") + " is used";
  else if (shows_sensor && !window.isWhole(sensor))
    model.remark = info_topic + ": its binning and ROI are not used, for the images show the whole sensor";
  if (!rectified && !reading.is_projection) model.lens = lensOf(info, info_topic);
  return model;
}

cv::Size imageSizeOf(const sensor_msgs::CameraInfo& info) { return windowOf(info).imageSize(); }

ColorCamera colorCameraFromInfo(const sensor_msgs::CameraInfo* info, const std::string& info_topic,
                                const std::string& image_topic, cv::Size image_size,
                                const CameraModel& depth_camera) {
  ColorCamera color;
  color.lens = depth_camera.lens;
  color.is_registered = info == nullptr || (info->K[0] == 0.0 && info->P[0] == 0.0);
  if (color.is_registered) return color;
  try {
    const CameraModel model = cameraFromInfo(*info, info_topic, image_topic, image_size);
    if (!sameCamera(model.intrinsics, depth_camera.intrinsics)) color.intrinsics = model.intrinsics;
    color.lens = model.lens;
    color.remark = model.remark;
  } catch (const Error& error) {
    color.problem = error.what();
  }
  return color;
}

}  // namespace depth_fusion
