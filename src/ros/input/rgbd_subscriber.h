// Depth images with the colour images that belong to them, from a driver's topics.
#pragma once

#include <ros/node_handle.h>
#include <ros/wall_timer.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <tf2_ros/transform_listener.h>

#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "ros/input/frame_counter.h"
#include "ros/in_process/frames.h"
#include "ros/input/lazy_registration.h"

namespace depth_fusion {

struct RgbdParameters {
  std::string depth_transport = "raw";
  std::string color_transport = "raw";
  float max_pairing_gap_s = 0.02f;
  float max_color_wait_s = 0.1f;
  RegistrationParameters registration;  // a table of its own

  ParameterTable table();
};

// Subscribes depth/image, depth/camera_info, rgb/image and rgb/camera_info of the node handle's namespace, or
// with a compressed transport depth/image/compressedDepth, rgb/image/compressed. A depth image goes on with
// the colour image nearest in time, or without one when none comes; what cannot be used is dropped, counted
// by its reason, and warned of. Frames come registered: without lens distortion, and with the way from the
// depth camera to the colour camera, which tf says where their frames differ.
class RgbdSubscriber {
 public:
  using Callback = std::function<void(const SensorFramePtr&)>;

  // Frames come in the order of their stamps, from the threads of the handle's callback queue.
  // device: as ComputeContext has it; opened if a frame needs it.
  RgbdSubscriber(ros::NodeHandle handle, const RgbdParameters& parameters, const std::string& device,
                 FrameCounter& counter, Callback callback);

  // For the images to come; the transports stay.
  void setParameters(const RgbdParameters& parameters);

  // Waits for what its callbacks are at.
  ~RgbdSubscriber();

  // What hinders frames now, for diagnostics; empty if nothing does.
  std::string problem() const;

 private:
  struct PendingDepth {
    std::shared_ptr<SensorFrame> frame;
    ros::WallTime received;
  };
  struct ColorImage {
    std_msgs::Header header;
    sensor_msgs::ImageConstPtr raw;  // one of the two
    sensor_msgs::CompressedImageConstPtr compressed;
  };

  void subscribe(ros::NodeHandle& handle);
  void onDepth(const std_msgs::Header& header, const std::function<void(SensorFrame&)>& decode);
  void onColor(ColorImage color);
  // Sees to the order of the stamps. False if the frame is not to be used.
  bool takeStamp(SensorFrame& frame);
  void takeCamera(SensorFrame& frame) const;
  void takeColorCamera(SensorFrame& frame) const;
  void registerFrame(SensorFrame& frame);
  // The colour camera's frame, if that is another than the depth's; else empty.
  std::string otherColorFrame(const std_msgs::Header& depth) const;
  Pose lookUpColorCamera(const std::string& color_frame, const std::string& depth_frame) const;
  // Sends on the depth images whose colour is there or will not come.
  void release();
  bool isComplete(const PendingDepth& depth);
  // What the camera_info topics and tf say about the cameras is there.
  bool knowsCameras(const std_msgs::Header& depth);
  void addColor(SensorFrame& frame);
  const ColorImage* nearestColor(const ros::Time& stamp) const;
  void drop(const std::string& reason, const std::string& detail = "");

  ros::NodeHandle handle_;
  RgbdParameters parameters_;
  LazyRegistration registration_;
  FrameCounter& counter_;
  Callback callback_;
  mutable std::mutex mutex_;
  std::string depth_topic_, color_topic_, info_topic_;
  ros::Subscriber depth_subscriber_, color_subscriber_, depth_info_subscriber_, color_info_subscriber_;
  ros::WallTimer timer_;
  sensor_msgs::CameraInfoConstPtr depth_info_, color_info_;
  std::deque<PendingDepth> pending_;
  std::deque<ColorImage> colors_;
  std::optional<ros::Time> last_stamp_;
  ros::WallTime last_depth_;  // arrived
  uint32_t clock_jumps_ = 0;
  std::string problem_;
  // Made when first needed:
  std::unique_ptr<tf2_ros::Buffer> tf_;
  std::unique_ptr<tf2_ros::TransformListener> tf_listener_;
};

}  // namespace depth_fusion
