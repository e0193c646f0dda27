#include <geometry_msgs/PoseStamped.h>
#include <rosbag/bag.h>
#include <sensor_msgs/image_encodings.h>
#include <tf2_msgs/TFMessage.h>

#include <filesystem>
#include <utility>

#include "depth_fusion/common/error.h"
#include "recording/depth_units.h"
#include "ros/bags/open_recording.h"
#include "ros/conversions/imu_conversion.h"
#include "ros/conversions/messages.h"

namespace depth_fusion {
namespace {

constexpr char kDepthNamespace[] = "/camera/depth_registered/";
constexpr char kColorNamespace[] = "/camera/rgb/";
constexpr char kCameraFrame[] = "camera_rgb_optical_frame";
constexpr char kWorldFrame[] = "world";
constexpr char kOdometryFrame[] = "odom";
constexpr char kBaseFrame[] = "base_link";
constexpr char kImuFrame[] = "imu_link";
constexpr double kStoredUnit_m = 0.001;

tf2_msgs::TFMessage transform(const ros::Time& stamp, const char* parent, const char* child,
                              const Pose& pose) {
  tf2_msgs::TFMessage message;
  message.transforms.push_back(makeTransform(makeHeader(stamp, parent), child, pose));
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
    const cv::Mat depth = convertDepthUnit(frame.depth, frame.depth_unit_m, kStoredUnit_m);
    const sensor_msgs::CameraInfo info = makeCameraInfo(header, frame.intrinsics);
    orError([&] {
      if (frame.T_W_D) writeTruth(header.stamp, *frame.T_W_D, frame.readings.T_B_D.has_value());
      if (frame.readings.T_B_D) writeRobot(header.stamp, frame.readings);
      writeImage(kDepthNamespace, info, makeImage(header, depth, sensor_msgs::image_encodings::TYPE_16UC1));
      if (!frame.color.empty()) writeImage(kColorNamespace, info, makeColorImage(header, frame.color));
    });
  }

  void finish() override {
    if (bag_ == nullptr) return;
    orError([&] { bag_->close(); });
    bag_.reset();
  }

 private:
  // The tree of a robot has another root; there the truth is a topic.
  void writeTruth(const ros::Time& stamp, const Pose& T_W_D, bool has_robot) {
    if (!has_robot) {
      bag_->write("/tf", stamp, transform(stamp, kWorldFrame, kCameraFrame, T_W_D));
      return;
    }
    geometry_msgs::PoseStamped truth;
    truth.header = makeHeader(stamp, kWorldFrame);
    truth.pose = toMessage(T_W_D);
    bag_->write("/ground_truth", stamp, truth);
  }

  void writeRobot(const ros::Time& stamp, const MotionReadings& readings) {
    const Pose& T_B_D = *readings.T_B_D;
    if (!std::exchange(has_tree_, true)) {
      tf2_msgs::TFMessage mounting = transform(stamp, kBaseFrame, kCameraFrame, T_B_D);
      const Pose T_B_I = Pose(Eigen::Translation3d(T_B_D.translation()));
      mounting.transforms.push_back(makeTransform(makeHeader(stamp, kBaseFrame), kImuFrame, T_B_I));
      bag_->write("/tf_static", stamp, mounting);
    }
    for (const OdometryReading& reading : readings.odometry) {
      const ros::Time at = toRosTime(reading.stamp_s);
      bag_->write("/tf", stamp, transform(at, kOdometryFrame, kBaseFrame, reading.T_O_D * T_B_D.inverse()));
    }
    for (const ImuReading& reading : readings.imu) {
      const std_msgs::Header header = makeHeader(toRosTime(reading.stamp_s), kImuFrame);
      bag_->write("/imu/data", header.stamp, makeImu(header, reading, T_B_D.linear()));
    }
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
  bool has_tree_ = false;
};

}  // namespace

std::unique_ptr<RecordingWriter> createBag(const std::string& path) {
  std::error_code unreadable;
  check(!std::filesystem::is_regular_file(path, unreadable),
        path + ": already exists; remove it or choose another name");
  return std::make_unique<BagWriter>(path);
}

}  // namespace depth_fusion
