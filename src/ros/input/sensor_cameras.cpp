#include "ros/input/sensor_cameras.h"

#include "depth_fusion/common/error.h"
#include "ros/conversions/camera_info.h"
#include "ros/conversions/messages.h"

namespace depth_fusion {
namespace {

constexpr uint32_t kTopicQueue = 30;

// The colour camera's frame if it is not the depth camera's, else an empty name.
std::string otherFrame(const sensor_msgs::CameraInfo* color, const std_msgs::Header& depth) {
  if (color == nullptr || depth.frame_id.empty() || color->header.frame_id == depth.frame_id) return "";
  return color->header.frame_id;
}

}  // namespace

SensorCameras::SensorCameras(ros::NodeHandle handle, const std::string& depth_topic,
                             const std::string& color_topic)
    : handle_(handle),
      depth_topic_(depth_topic),
      color_topic_(color_topic),
      info_topic_(handle.resolveName("depth/camera_info")),
      depth_subscriber_(subscribe(handle, "depth/camera_info", &Infos::depth)),
      color_subscriber_(subscribe(handle, "rgb/camera_info", &Infos::color)) {}

SensorCameras::~SensorCameras() {
  depth_subscriber_.shutdown();
  color_subscriber_.shutdown();
}

ros::Subscriber SensorCameras::subscribe(ros::NodeHandle& handle, const std::string& name,
                                         sensor_msgs::CameraInfoConstPtr Infos::*info) {
  return handle.subscribe<sensor_msgs::CameraInfo>(
      name, kTopicQueue, [this, info](const sensor_msgs::CameraInfoConstPtr& message) {
        const std::lock_guard<std::mutex> lock(mutex_);
        infos_.*info = message;
      });
}

SensorCameras::Infos SensorCameras::latest() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return infos_;
}

bool SensorCameras::areKnown(const std_msgs::Header& depth) {
  const Infos infos = latest();
  if (infos.depth == nullptr) return false;
  const std::string color_frame = otherFrame(infos.color.get(), depth);
  return color_frame.empty() || tf().canTransform(color_frame, depth.frame_id, ros::Time(0));
}

std::string SensorCameras::describe(SensorFrame& frame) {
  const Infos infos = latest();
  describeDepth(infos.depth.get(), frame.rgbd);
  return describeColor(infos.color.get(), frame);
}

void SensorCameras::describeDepth(const sensor_msgs::CameraInfo* info, RgbdFrame& frame) const {
  check(info != nullptr,
        "no camera_info yet on " + info_topic_ + "; remap depth/camera_info to the driver's");
  const CameraModel model = cameraFromInfo(*info, info_topic_, depth_topic_, frame.depth.size());
  frame.intrinsics = model.intrinsics;
  frame.distortion = frame.color_distortion = model.lens;
}

std::string SensorCameras::describeColor(const sensor_msgs::CameraInfo* info, SensorFrame& frame) {
  if (info == nullptr) return "";
  RgbdFrame& rgbd = frame.rgbd;
  const cv::Size size = rgbd.color.empty() ? imageSizeOf(*info) : rgbd.color.size();
  const ColorCamera camera = colorCameraFromInfo(info, color_topic_ + "'s camera_info", color_topic_, size,
                                                 {rgbd.intrinsics, rgbd.distortion, {}});
  rgbd.color_intrinsics = camera.intrinsics;
  rgbd.color_distortion = camera.lens;
  if (!camera.problem.empty()) rgbd.color_problem = camera.problem;
  if (camera.is_registered) return "";
  const std::string color_frame = otherFrame(info, frame.header);
  if (!color_frame.empty()) frame.rgbd.T_C_D = lookUp(color_frame, frame.header.frame_id);
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
