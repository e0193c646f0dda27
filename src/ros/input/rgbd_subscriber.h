// Depth images with the colour images that belong to them, from a driver's topics.
#pragma once

#include <ros/wall_timer.h>

#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "ros/callbacks/callback_gate.h"
#include "ros/in_process/frame_counter.h"
#include "ros/input/image_topic.h"
#include "ros/input/mask_topic.h"
#include "ros/input/rgbd_decoder.h"
#include "ros/input/rgbd_pairing.h"
#include "ros/input/robot_body.h"
#include "ros/input/stamp_policy.h"
#include "ros/input/topic_watch.h"

namespace depth_fusion {

// Subscribes depth/image, depth/camera_info, rgb/image, rgb/camera_info and mask of the node handle's
// namespace, or with a compressed transport depth/image/compressedDepth, rgb/image/compressed. A depth image
// goes on with the colour image nearest in time, or without one when none comes; while masks are published,
// with its mask, or not at all. Who takes them decodes them when their turn comes. What cannot be used is
// dropped, counted by its reason, and warned of; what is wrong with colour leaves colour out.
class RgbdSubscriber {
 public:
  using Callback = std::function<void(const RgbdMessagesPtr&)>;

  // Messages come one at a time and in the order of their stamps, from the threads of the handle's callback
  // queue; the callback is to hand them on, and not to wait. device: as ComputeContext has it; opened if a
  // frame needs it.
  RgbdSubscriber(ros::NodeHandle handle, const RgbdParameters& parameters, const std::string& device,
                 FrameCounter& counter, Callback callback);
  // Waits for the callback in progress; there is none afterwards.
  ~RgbdSubscriber() = default;

  // Does what RgbdDecoder does, and cuts the robot's body out. Null if the frame is dropped. For one thread.
  SensorFramePtr decode(const RgbdMessages& messages);

  // For the images to come; the transports stay.
  void setParameters(const RgbdParameters& parameters);

  // What hinders frames now, for diagnostics; empty if nothing does.
  std::string problem() const;
  bool hasColor() const { return color_.isPublished(); }

 private:
  void onDepth(const ImageMessage& image);
  void onColor(const ImageMessage& image);
  // Sees to the order of the stamps. False if the image is not to be used.
  bool takeStamp(RgbdMessages& messages);
  void restart(const StampPolicy::Verdict& jump);
  // Hands on what is complete, unless some thread is at that already, which then sees to this, too.
  void deliverComplete();
  RgbdMessagesPtr takeComplete();
  // Whether the first that waits has all that it is to have, or has waited long enough.
  bool isComplete(const RgbdMessages& first);
  RgbdMessagesPtr withMask(const RgbdMessagesPtr& messages) const;
  void drop(const std::string& reason, const std::string& detail);

  FrameCounter& counter_;
  const Callback callback_;
  RgbdDecoder decoder_;     // only decode() uses it, but for the cameras
  SaidOnce said_of_color_;  // only decode() uses it
  StampPolicy stamps_;      // only onDepth() uses it
  TopicWatch watch_;

  mutable std::mutex mutex_;  // guards the rest up to the topics, and is never held during the callback
  bool delivering_ = false;   // some thread is
  bool awaits_cameras_ = true;
  RgbdParameters parameters_;
  RgbdPairing pairing_;
  std::string problem_, color_problem_;  // of images that came

  // These are last: they end, and with them every callback, before anything that the callbacks use.
  RobotBody body_;
  MaskTopic masks_;
  ImageTopic color_, depth_;
  CallbackGate callbacks_;
  ros::WallTimer release_timer_, look_timer_;
};

}  // namespace depth_fusion
