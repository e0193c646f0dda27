#include <geometry_msgs/TransformStamped.h>
#include <rosbag/bag.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/image_encodings.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <filesystem>

#include "depth_fusion/common/error.h"
#include "recording/depth_units.h"
#include "ros/recording.h"

namespace depth_fusion {
namespace {

constexpr char kDepthNamespace[] = "/camera/depth_registered/";
constexpr char kColorNamespace[] = "/camera/rgb/";
constexpr char kCameraFrame[] = "camera_rgb_optical_frame";
constexpr char kWorldFrame[] = "world";
constexpr double kMillimetre_m = 0.001;

// ROS reads a stamp of zero as "no time".
ros::Time toRosTime(double stamp_s) {
  constexpr double kEndOfTime_s = 4294967296.0;
  check(stamp_s >= 0.0 && stamp_s < kEndOfTime_s,
        "a bag holds stamps from 0 to 2^32 s; this frame's is " + std::to_string(stamp_s));
  return std::max(ros::Time(stamp_s), ros::TIME_MIN);
}

std_msgs::Header makeHeader(const ros::Time& stamp, const std::string& frame_id) {
  std_msgs::Header header;
  header.stamp = stamp;
  header.frame_id = frame_id;
  return header;
}

sensor_msgs::Image makeImage(const std_msgs::Header& header, const cv::Mat& pixels,
                             const std::string& encoding) {
  sensor_msgs::Image image;
  image.header = header;
  image.width = static_cast<uint32_t>(pixels.cols);
  image.height = static_cast<uint32_t>(pixels.rows);
  image.encoding = encoding;
  image.step = static_cast<uint32_t>(pixels.cols * pixels.elemSize());
  for (int row = 0; row < pixels.rows; ++row) {
    image.data.insert(image.data.end(), pixels.ptr(row), pixels.ptr(row) + image.step);
  }
  return image;
}

sensor_msgs::CameraInfo makeCameraInfo(const std_msgs::Header& header, const CameraIntrinsics& camera) {
  sensor_msgs::CameraInfo info;
  info.header = header;
  info.width = static_cast<uint32_t>(camera.width);
  info.height = static_cast<uint32_t>(camera.height);
  info.distortion_model = "plumb_bob";
  info.D.assign(5, 0.0);
  info.K = {camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0};
  info.R = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  info.P = {camera.fx, 0.0, camera.cx, 0.0, 0.0, camera.fy, camera.cy, 0.0, 0.0, 0.0, 1.0, 0.0};
  return info;
}

tf2_msgs::TFMessage makeTransform(const ros::Time& stamp, const Pose& T_W_D) {
  const Eigen::Quaterniond rotation(T_W_D.linear());
  geometry_msgs::TransformStamped transform;
  transform.header = makeHeader(stamp, kWorldFrame);
  transform.child_frame_id = kCameraFrame;
  transform.transform.translation.x = T_W_D.translation().x();
  transform.transform.translation.y = T_W_D.translation().y();
  transform.transform.translation.z = T_W_D.translation().z();
  transform.transform.rotation.x = rotation.x();
  transform.transform.rotation.y = rotation.y();
  transform.transform.rotation.z = rotation.z();
  transform.transform.rotation.w = rotation.w();
  tf2_msgs::TFMessage message;
  message.transforms.push_back(transform);
  return message;
}

class BagWriter : public RecordingWriter {
 public:
  explicit BagWriter(const std::string& path) : path_(path), bag_(std::make_unique<rosbag::Bag>()) {
    orError([&] { bag_->open(path_, rosbag::bagmode::Write); });
  }

  ~BagWriter() override {
    try {
      finish();
    } catch (const Error&) {
      // Whoever wanted to know has called finish().
    }
  }

  void write(const RgbdFrame& frame) override {
    check(bag_ != nullptr, path_ + ": the bag is closed already");
    const std_msgs::Header header = makeHeader(toRosTime(frame.stamp_s), kCameraFrame);
    const cv::Mat depth = convertDepthUnit(frame.depth, frame.depth_unit_m, kMillimetre_m);
    const sensor_msgs::CameraInfo info = makeCameraInfo(header, frame.intrinsics);
    orError([&] {
      if (frame.T_W_D) bag_->write("/tf", header.stamp, makeTransform(header.stamp, *frame.T_W_D));
      writeImage(kDepthNamespace, info, makeImage(header, depth, sensor_msgs::image_encodings::TYPE_16UC1));
      if (!frame.color.empty()) writeImage(kColorNamespace, info, makeColor(header, frame.color));
    });
  }

  void finish() override {
    if (bag_ == nullptr) return;
    orError([&] { bag_->close(); });
    bag_.reset();
  }

 private:
  static sensor_msgs::Image makeColor(const std_msgs::Header& header, const cv::Mat& color) {
    const bool is_gray = color.type() == CV_8UC1;
    check(is_gray || color.type() == CV_8UC3,
          "a recording is written from colour of type CV_8UC3 or CV_8UC1");
    return makeImage(header, color,
                     is_gray ? sensor_msgs::image_encodings::MONO8 : sensor_msgs::image_encodings::BGR8);
  }

  void writeImage(const std::string& topic_namespace, const sensor_msgs::CameraInfo& info,
                  const sensor_msgs::Image& image) {
    bag_->write(topic_namespace + "camera_info", info.header.stamp, info);
    bag_->write(topic_namespace + "image_raw", info.header.stamp, image);
  }

  template <class Action>
  void orError(const Action& action) {
    try {
      action();
    } catch (const ros::Exception& error) {
      abandonBag();
      throw Error(path_ + ": the bag cannot be written: " + error.what());
    }
  }

  // A bag that cannot be closed would throw in its destructor, which ends the program: it is never destroyed.
  void abandonBag() {
    try {
      bag_->close();
      bag_.reset();
    } catch (const ros::Exception&) {
      bag_.release();
    }
  }

  std::string path_;
  std::unique_ptr<rosbag::Bag> bag_;
};

}  // namespace

std::unique_ptr<RecordingWriter> createBag(const std::string& path) {
  std::error_code unreadable;
  check(!std::filesystem::is_regular_file(path, unreadable), path + ": already exists; remove it or choose another name");
  return std::make_unique<BagWriter>(path);
}

}  // namespace depth_fusion
