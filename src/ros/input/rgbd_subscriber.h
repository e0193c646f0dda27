// Depth images with the colour images that belong to them, from a driver's topics.
#pragma once

#include <ros/wall_timer.h>

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "ros/callbacks/callback_gate.h"
#include "ros/in_process/frame_counter.h"
#include "ros/input/image_topic.h"
#include "ros/input/lazy_registration.h"
#include "ros/input/rgbd_pairing.h"
#include "ros/input/sensor_cameras.h"
#include "ros/input/stamp_policy.h"

namespace depth_fusion {

// Subscribes depth/image, depth/camera_info, rgb/image and rgb/camera_info of the node handle's namespace, or
// with a compressed transport depth/image/compressedDepth, rgb/image/compressed. A depth image goes on with
// the colour image nearest in time, or without one when none comes; what cannot be used is dropped, counted
// by its reason, and warned of. Frames come registered: without lens distortion, and with the way from the
// depth camera to the colour camera, which tf says where their frames differ.
class RgbdSubscriber {
 public:
  using Callback = std::function<void(const SensorFramePtr&)>;

  // Frames come one at a time and in the order of their stamps, from the threads of the handle's callback
  // queue. device: as ComputeContext has it; opened if a frame needs it.
  RgbdSubscriber(ros::NodeHandle handle, const RgbdParameters& parameters, const std::string& device,
                 FrameCounter& counter, Callback callback);
  // Waits for the callback in progress; there is none afterwards.
  ~RgbdSubscriber() = default;

  // For the images to come; the transports stay. Does not wait for a frame at work.
  void setParameters(const RgbdParameters& parameters);

  // What hinders frames now, for diagnostics; empty if nothing does. Does not wait for a frame at work.
  std::string problem() const;

 private:
  void onDepth(const ImageMessage& image);
  void onColor(const ImageMessage& image);
  // Sees to the order of the stamps. False if the frame is not to be used.
  bool takeStamp(SensorFrame& frame);
  // Waits for its turn, then sends on the frames that are complete. Messages so wait on their topics while a
  // frame is at work.
  void deliverComplete();
  std::optional<RgbdPairing::Pair> takeComplete();
  void deliver(const RgbdPairing::Pair& pair, const RegistrationParameters& registration);
  void decodeColor(SensorFrame& frame, const ImageMessage& image) const;
  // Leaves colour out that cannot be used, and warns of it.
  void checkColor(RgbdFrame& frame) const;
  void drop(const std::string& reason, const std::string& detail);

  const std::string depth_topic_, color_topic_;
  FrameCounter& counter_;
  const Callback callback_;
  SensorCameras cameras_;
  StampPolicy stamps_;             // only onDepth() uses it
  LazyRegistration registration_;  // only the thread that delivers uses it

  mutable std::mutex mutex_;  // guards the next six, and is never held while a frame is at work
  std::condition_variable turn_;
  bool delivering_ = false;  // some thread is
  RegistrationParameters registration_parameters_;
  RgbdPairing pairing_;
  ros::WallTime last_depth_;  // when it arrived
  std::string problem_;

  // These are last: they end, and with them every callback, before anything that the callbacks use.
  ImageTopic color_, depth_;
  CallbackGate callbacks_;
  ros::WallTimer timer_;
};

}  // namespace depth_fusion
