#include "ros/input/sensor_cameras.h"

#include "depth_fusion/common/error.h"
#include "ros/conversions/camera_info.h"
#include "ros/conversions/messages.h"

namespace depth_fusion {
namespace {

constexpr uint32_t kInfoQueue = 30;
constexpr size_t kInfosKept = 30;

// The colour camera's frame if it is not the depth camera's, else an empty name.
std::string otherFrame(const sensor_msgs::CameraInfo* color, const std_msgs::Header& depth) {
  const std::string color_frame = color == nullptr ? "" : withoutSlash(color->header.frame_id);
  return depth.frame_id.empty() || color_frame == depth.frame_id ? "" : color_frame;
}

}  // namespace

SensorCameras::SensorCameras(ros::NodeHandle handle)
    : handle_(handle),
      depth_info_topic_(handle.resolveName("depth/camera_info")),
      color_info_topic_(handle.resolveName("rgb/camera_info")),
      depth_subscriber_(subscribe(depth_info_topic_, depth_infos_)),
      color_subscriber_(subscribe(color_info_topic_, color_infos_)) {}

SensorCameras::~SensorCameras() {
  depth_subscriber_.shutdown();
  color_subscriber_.shutdown();
}

ros::Subscriber SensorCameras::subscribe(const std::string& name, Infos& infos) {
  return handle_.subscribe<sensor_msgs::CameraInfo>(
      name, kInfoQueue, [this, &infos](const sensor_msgs::CameraInfoConstPtr& message) {
        const std::lock_guard<std::mutex> lock(mutex_);
        infos.push_back(message);
        if (infos.size() > kInfosKept) infos.pop_front();
      });
}

sensor_msgs::CameraInfoConstPtr SensorCameras::find(const Infos& infos, const ros::Time& stamp) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (auto info = infos.rbegin(); info != infos.rend(); ++info) {
    if ((*info)->header.stamp == stamp) return *info;
  }
  return infos.empty() ? nullptr : infos.back();
}

bool SensorCameras::hasDepth() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return !depth_infos_.empty();
}

bool SensorCameras::areKnown(const std_msgs::Header& depth) {
  if (!hasDepth()) return false;
  const std::string color_frame = otherFrame(find(color_infos_, depth.stamp).get(), depth);
  return color_frame.empty() || tf().canTransform(color_frame, depth.frame_id, ros::Time(0));
}

CameraIntrinsics SensorCameras::depthCamera(const ros::Time& stamp) const {
  const auto info = find(depth_infos_, stamp);
  check(info != nullptr, "no camera_info yet on " + depth_info_topic_ +
                             "; a cloud that is a list of points is projected into the image of that camera");
  return cameraFromInfo(*info, depth_info_topic_, depth_info_topic_, imageSizeOf(*info)).intrinsics;
}

std::string SensorCameras::describe(const RgbdMessages& messages, SensorFrame& frame) {
  const ros::Time& stamp = messages.depth.header().stamp;
  describeDepth(find(depth_infos_, stamp).get(), messages.depth_topic, frame.rgbd);
  const auto color = find(color_infos_, messages.color.empty() ? stamp : messages.color.header().stamp);
  if (color == nullptr) return "";
  try {
    return describeColor(*color, messages.color_topic, frame);
  } catch (const std::exception& error) {
    frame.rgbd.color_problem = error.what();
    return "";
  }
}

void SensorCameras::describeDepth(const sensor_msgs::CameraInfo* info, const std::string& topic,
                                  RgbdFrame& frame) const {
  check(info != nullptr,
        "no camera_info yet on " + depth_info_topic_ + "; remap depth/camera_info to the driver's");
  const CameraModel model = cameraFromInfo(*info, depth_info_topic_, topic, frame.depth.size());
  frame.intrinsics = model.intrinsics;
  frame.distortion = frame.color_distortion = model.lens;
}

std::string SensorCameras::describeColor(const sensor_msgs::CameraInfo& info, const std::string& topic,
                                         SensorFrame& frame) {
  RgbdFrame& rgbd = frame.rgbd;
  const cv::Size size = rgbd.color.empty() ? imageSizeOf(info) : rgbd.color.size();
  const ColorCamera camera =
      colorCameraFromInfo(&info, color_info_topic_, topic, size, {rgbd.intrinsics, rgbd.distortion, {}});
  rgbd.color_intrinsics = camera.intrinsics;
  rgbd.color_distortion = camera.lens;
  if (!camera.problem.empty()) rgbd.color_problem = camera.problem;
  if (camera.is_registered) return "";
  const std::string color_frame = otherFrame(&info, frame.header);
  if (!color_frame.empty()) rgbd.T_C_D = lookUp(color_frame, frame.header.frame_id);
  return color_frame;
}

Pose SensorCameras::lookUp(const std::string& color_frame, const std::string& depth_frame) {
  try {
    return fromMessage(tf().lookupTransform(color_frame, depth_frame, ros::Time(0)).transform);
  } catch (const tf2::TransformException&) {
    throw Error("depth is in the frame " + depth_frame + ", colour in " + color_frame +
                ", and tf does not connect them; publish where the cameras are (rosrun tf2_ros "
                "static_transform_publisher X Y Z YAW PITCH ROLL " +
                color_frame + " " + depth_frame + "), or let the driver register depth to colour");
  }
}

tf2_ros::Buffer& SensorCameras::tf() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (tf_ == nullptr) {
    tf_ = std::make_unique<tf2_ros::Buffer>();
    tf_listener_ = std::make_unique<tf2_ros::TransformListener>(*tf_, handle_);
  }
  return *tf_;
}

}  // namespace depth_fusion
