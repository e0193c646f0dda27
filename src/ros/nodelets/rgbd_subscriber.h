// Depth images with the colour images that belong to them, from a driver's topics.
#pragma once

#include <ros/node_handle.h>
#include <ros/wall_timer.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>

#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "depth_fusion/common/parameters.h"
#include "ros/nodelets/frame_counter.h"
#include "ros/nodelets/frames.h"

namespace depth_fusion {

struct RgbdParameters {
  std::string depth_transport = "raw";
  std::string color_transport = "raw";
  float max_pairing_gap_s = 0.02f;
  float max_color_wait_s = 0.1f;

  ParameterTable table();
};

// Subscribes depth/image, depth/camera_info, rgb/image and rgb/camera_info of the node handle's namespace, or with a
// compressed transport depth/image/compressedDepth, rgb/image/compressed. A depth image goes on with the colour image nearest
// in time, or without one when none comes; what cannot be used is dropped, counted by its reason, and warned of.
class RgbdSubscriber {
 public:
  using Callback = std::function<void(const SensorFramePtr&)>;

  // Frames come in the order of their stamps, from the threads of the handle's callback queue.
  RgbdSubscriber(ros::NodeHandle handle, const RgbdParameters& parameters, FrameCounter& counter, Callback callback);

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
  // Sends on the depth images whose colour is there or will not come.
  void release();
  bool isComplete(const PendingDepth& depth) const;
  void addColor(SensorFrame& frame);
  const ColorImage* nearestColor(const ros::Time& stamp) const;
  void drop(const std::string& reason, const std::string& detail = "");

  RgbdParameters parameters_;
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
  uint32_t clock_jumps_ = 0;
  std::string problem_;
};

}  // namespace depth_fusion
