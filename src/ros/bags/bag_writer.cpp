#include <rosbag/bag.h>
#include <sensor_msgs/image_encodings.h>
#include <tf2_msgs/TFMessage.h>

#include <filesystem>

#include "depth_fusion/common/error.h"
#include "recording/depth_units.h"
#include "ros/bags/open_recording.h"
#include "ros/conversions/messages.h"

namespace depth_fusion {
namespace {

constexpr char kDepthNamespace[] = "/camera/depth_registered/";
constexpr char kColorNamespace[] = "/camera/rgb/";
constexpr char kCameraFrame[] = "camera_rgb_optical_frame";
constexpr char kWorldFrame[] = "world";
constexpr double kMillimetre_m = 0.001;

tf2_msgs::TFMessage cameraTransform(const std_msgs::Header& header, const Pose& T_W_D) {
  tf2_msgs::TFMessage message;
  message.transforms.push_back(makeTransform(makeHeader(header.stamp, kWorldFrame), header.frame_id, T_W_D));
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
      if (frame.T_W_D) bag_->write("/tf", header.stamp, cameraTransform(header, *frame.T_W_D));
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
  check(!std::filesystem::is_regular_file(path, unreadable),
        path + ": already exists; remove it or choose another name");
  return std::make_unique<BagWriter>(path);
}

}  // namespace depth_fusion
