// Tracking among nodelets: the session, concluded by tsdf_fusion's answers, through clock jumps, skipped
// frames, other maps and other cameras.
#pragma once

#include <depth_fusion/TrackerStatus.h>

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "depth_fusion/pipeline/tracking_session.h"
#include "depth_fusion/robot_motion/robot_motion.h"
#include "ros/in_process/fusion_link.h"
#include "ros/in_process/live_tracker_parameters.h"
#include "ros/in_process/shared_map.h"
#include "ros/in_process/skipped_frames.h"

namespace depth_fusion {

constexpr char kLost[] = "lost";

// What became of a frame.
struct LiveResult {
  TrackingResult tracking;
  std::string lost_for = kLost;  // what a lost frame is counted as
};

class LiveTracker {
 public:
  // The rest of the robot, where the poses go.
  struct Robot {
    // Of the frame that begins a map; `up_camera` is the direction against gravity, where it is known.
    std::function<Pose(const std_msgs::Header& camera, const std::optional<Eigen::Vector3d>& up_camera)>
        start_pose;
    std::function<void()> forget_poses;                     // they are those of a map that is gone
    std::function<void(const Corrections&)> correct_poses;  // the map has moved
    // Those of its other sensors until the frame of that stamp.
    std::function<MotionReadings(const std_msgs::Header& camera, double stamp_s)> readings;
  };

  // `frames` is the topic icp_tracking/frame. Keeps a reference to the parameters, which may change between
  // frames.
  LiveTracker(const LiveTrackerParameters& parameters, const ros::Publisher& frames, Robot robot)
      : parameters_(parameters),
        fusion_(frames),
        robot_(std::move(robot)),
        robot_motion_(parameters.pipeline.robot_motion) {}

  // From any thread:
  FusionLink& fusion() { return fusion_; }
  void skip(const TexturedSensorFrame& frame) { skipped_.add(frame); }
  // Somebody says where the robot's base is in the map: the sensor is searched for there.
  void expectAt(const Pose& T_map_base);

  // From one thread:
  // Takes over parameters that have changed. Throws Error if they do not fit together.
  void applyParameters();
  // Waits for fusion's answer to the frame sent last, and concludes that frame. Throws Error if the device
  // fails.
  void conclude();
  // Finds the frame's pose, or says why it is not to be tracked. Throws Error if the frame cannot be used or
  // the device fails.
  LiveResult track(const TexturedSensorFrame& frame, StageTimers& timers);
  // What became of a frame that failed with an error.
  LiveResult fail(const std::string& error);
  // Sends the frame tracked last, which has a pose, to fusion.
  void send(const SensorFramePtr& frame, const TrackingResult& tracking);

  // The status after the frame, without the account of frames.
  TrackerStatus statusOf(const SensorFrame& frame, const LiveResult& result) const;
  std::string deviceName() const { return compute_ == nullptr ? "" : compute_->device().name; }

 private:
  PipelineParameters pipelineParameters() const;
  // Readies the session for the frame's camera and the parameters of its texture.
  void readySession(const TexturedSensorFrame& frame);
  void makeSession(const CameraIntrinsics& camera);
  void apply(const FusionNews& news);
  // Takes in what came before the frame: a clock set back, a map that is gone, frames skipped.
  void catchUp(const SensorFrame& frame);
  // Why the frame is not to be tracked at all; empty if it is.
  std::string refusal(const SensorFrame& frame) const;
  // Begins anew with what fusion shows of its map; null: nothing yet.
  void changeMap(const std::shared_ptr<const MapView>& map);
  // The view of the last fused frame; null if there is nothing to be seen yet.
  const ModelView* view() const { return map_ == nullptr ? nullptr : map_->view.get(); }
  // The pose of the view; the origin without one.
  Pose viewPose() const { return view() == nullptr ? Pose::Identity() : view()->T_W_D; }
  void warnOfNoise();
  // What seeks loops in the map; nothing where they are not sought.
  LoopsOfMap loops() const;
  // Has the frame that was just fused seek loops.
  bool keepsPictures() const;  // whether keyframes have them
  void seekLoops();
  // The sensor has been lost for long: another part of the map begins with the next frame, where loops are
  // sought that may join it with the rest.
  void beginPart();
  // Lets whoever saves the map have its keyframes.
  void shareKeyframes();
  Keyframes keyframesOf(const std::shared_ptr<const MapView>& map) const;
  void searchAtExpected();
  // The map as seen from anywhere, for relocalisation. Throws Error if it is gone.
  const ModelView& render(const Pose& T_W_D);

  const LiveTrackerParameters& parameters_;
  FusionLink fusion_;
  Robot robot_;
  SkippedFrames skipped_;
  RobotMotion robot_motion_;

  std::shared_ptr<ComputeContext> compute_;
  std::unique_ptr<TrackingSession> session_;
  CameraIntrinsics camera_;
  std::shared_ptr<const TextureOdometryParameters> texture_;  // as last seen
  SensorFramePtr sent_;                                       // to fusion, the last one
  std::shared_ptr<const MapView> map_;                        // what fusion last showed of it; null: nothing
  std::shared_ptr<const ModelView> rendered_;  // what render() returned last, while a frame is tracked
  uint32_t clock_jumps_ = 0;
  bool noise_was_said_ = false;
  KeyframePtr last_shared_;
  std::mutex expected_mutex_;
  std::optional<Pose> T_map_base_;  // as somebody said, until the next frame
};

}  // namespace depth_fusion
