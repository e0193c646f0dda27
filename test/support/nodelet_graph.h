// Nodelets that are loaded into the test's own process, which is their manager, and a stream of frames for
// them.
#pragma once

#include <depth_fusion/MapStatus.h>
#include <depth_fusion/TrackerStatus.h>
#include <gtest/gtest.h>
#include <nodelet/loader.h>
#include <ros/ros.h>

#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "ros/conversions/messages.h"
#include "support/simulated_frames.h"
#include "tools/simulation/simulated_recording.h"

namespace depth_fusion {

constexpr double kPatience_s = 120.0;

// Keeps everything that is received on a topic.
template <class Message>
class Listener {
 public:
  using Ptr = boost::shared_ptr<const Message>;

  Listener(ros::NodeHandle& handle, const std::string& topic)
      : subscriber_(handle.subscribe<Message>(topic, 1000, [this](const Ptr& message) {
          const std::lock_guard<std::mutex> lock(mutex_);
          messages_.push_back(message);
          changed_.notify_all();
        })) {}

  std::vector<Ptr> all() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return messages_;
  }
  size_t count() const { return all().size(); }

  // Waits for the first message that fits; returns null if none comes.
  Ptr await(const std::function<bool(const Message&)>& fits, double patience_s = kPatience_s) const {
    std::unique_lock<std::mutex> lock(mutex_);
    Ptr found;
    size_t seen = 0;
    changed_.wait_for(lock, std::chrono::duration<double>(patience_s), [&] {
      for (; seen < messages_.size() && found == nullptr; ++seen) {
        if (fits(*messages_[seen])) found = messages_[seen];
      }
      return found != nullptr;
    });
    return found;
  }
  Ptr awaitStamp(const ros::Time& stamp, double patience_s = kPatience_s) const {
    return await([&](const Message& message) { return message.header.stamp == stamp; }, patience_s);
  }
  bool awaitCount(size_t count, double patience_s = kPatience_s) const {
    std::unique_lock<std::mutex> lock(mutex_);
    return changed_.wait_for(lock, std::chrono::duration<double>(patience_s),
                             [&] { return messages_.size() >= count; });
  }
  bool connected() const { return subscriber_.getNumPublishers() > 0; }

 private:
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  std::vector<Ptr> messages_;
  ros::Subscriber subscriber_;
};

inline bool eventually(const std::function<bool()>& condition, double patience_s = kPatience_s) {
  for (double waited_s = 0.0; waited_s < patience_s; waited_s += 0.01) {
    if (condition()) return true;
    ros::WallDuration(0.01).sleep();
  }
  return condition();
}

// Runs nodelets in a namespace of their own.
class NodeletGraph {
 public:
  explicit NodeletGraph(const std::string& name) : handle_("/" + name), spinner_(3) { spinner_.start(); }
  ~NodeletGraph() {
    for (const auto& name : loader_.listLoadedNodelets()) loader_.unload(name);
    ros::param::del(handle_.getNamespace());
  }

  ros::NodeHandle& handle() { return handle_; }
  std::string resolve(const std::string& name) const { return handle_.resolveName(name); }

  bool load(const std::string& name, const std::string& type) {
    return loader_.load(resolve(name), "depth_fusion/" + type, {}, {});
  }
  bool load(const std::string& type) { return load(type, type); }
  bool unload(const std::string& name) { return loader_.unload(resolve(name)); }
  void loadTracking() {
    ASSERT_TRUE(load("tsdf_fusion"));
    ASSERT_TRUE(load("icp_tracking"));
    ASSERT_TRUE(load("texture_odometry"));
  }

 private:
  ros::NodeHandle handle_;
  ros::AsyncSpinner spinner_;
  nodelet::Loader loader_{false};
};

// Describes frames of the simulated room with a quarter of the usual pixels.
inline SimulationOptions smallRoom(int frames) {
  SimulationOptions options;
  options.frames = frames;
  options.intrinsics = {320, 240, 262.5, 262.5, 159.5, 119.5};
  return options;
}

// Publishes frames as a driver does, with colour in a tf frame of its own if that is given.
class FakeCamera {
 public:
  explicit FakeCamera(ros::NodeHandle& handle, const std::string& frame_id = "camera_rgb_optical_frame",
                      const std::string& color_frame_id = "")
      : frame_id_(frame_id),
        color_frame_id_(color_frame_id.empty() ? frame_id : color_frame_id),
        depth_(handle.advertise<sensor_msgs::Image>("depth/image", 10)),
        depth_info_(handle.advertise<sensor_msgs::CameraInfo>("depth/camera_info", 10)),
        color_(handle.advertise<sensor_msgs::Image>("rgb/image", 10)),
        color_info_(handle.advertise<sensor_msgs::CameraInfo>("rgb/camera_info", 10)) {}

  bool awaitSubscribers() const {
    return eventually([&] {
      return depth_.getNumSubscribers() > 0 && depth_info_.getNumSubscribers() > 0 &&
             color_.getNumSubscribers() > 0 && color_info_.getNumSubscribers() > 0;
    });
  }

  std_msgs::Header headerOf(const RgbdFrame& frame) const {
    return makeHeader(toRosTime(frame.stamp_s), frame_id_);
  }

  void publishColor(const RgbdFrame& frame) {
    const std_msgs::Header header = makeHeader(toRosTime(frame.stamp_s), color_frame_id_);
    color_info_.publish(makeCameraInfo(header, colorCamera(frame), frame.color_distortion));
    color_.publish(boost::make_shared<sensor_msgs::Image>(makeColorImage(header, frame.color)));
  }
  sensor_msgs::ImageConstPtr publishDepth(const RgbdFrame& frame) {
    depth_info_.publish(makeCameraInfo(headerOf(frame), frame.intrinsics, frame.distortion));
    const auto image = boost::make_shared<sensor_msgs::Image>(
        makeDepthImage(headerOf(frame), frame.depth, frame.depth_unit_m));
    depth_.publish(image);
    return image;
  }
  sensor_msgs::ImageConstPtr publish(const RgbdFrame& frame) {
    publishColor(frame);
    return publishDepth(frame);
  }

 private:
  std::string frame_id_, color_frame_id_;
  ros::Publisher depth_, depth_info_, color_, color_info_;
};

// Converts depth to what sensors give: millimetres in 16 bits.
inline RgbdFrame inMillimetres(RgbdFrame frame) {
  frame.depth.convertTo(frame.depth, CV_16U, 1000.0);
  frame.depth_unit_m = 0.001;
  return frame;
}

inline std::vector<RgbdFrame> simulatedFrames(const SimulationOptions& options,
                                              double first_stamp_s = 100.0) {
  SimulatedRecording recording(options);
  std::vector<RgbdFrame> frames;
  while (const auto frame = recording.next()) {
    frames.push_back(inMillimetres(*frame));
    frames.back().stamp_s = toRosTime(first_stamp_s + frame->stamp_s).toSec();
  }
  return frames;
}

}  // namespace depth_fusion
