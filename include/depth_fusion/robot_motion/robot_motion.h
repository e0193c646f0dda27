// What the robot's other sensors tell of each frame's pose, and what is wrong with them.
#pragma once

#include <optional>
#include <string>

#include "depth_fusion/frames/robot_knowledge.h"
#include "depth_fusion/robot_motion/gravity.h"
#include "depth_fusion/robot_motion/gyroscope.h"
#include "depth_fusion/robot_motion/odometry_watch.h"
#include "depth_fusion/robot_motion/wheel_odometry.h"

namespace depth_fusion {

class RobotMotion {
 public:
  explicit RobotMotion(const RobotMotionParameters& parameters) { setParameters(parameters); }

  // Throws Error if a value is out of range.
  void setParameters(const RobotMotionParameters& parameters);
  // Takes readings, until the frame that is asked for next or later.
  void add(const MotionReadings& readings);
  // What the readings tell of the frame. Every frame is asked for once, in the order of the stamps.
  RobotKnowledge knowledge(double stamp_s);
  // Tracking found the frame that was asked for last; by an error of the sensors it learns.
  void learn(double stamp_s, const Pose& T_W_D);
  // T_B_D; none where there is no base.
  const std::optional<Pose>& cameraOnBase() const { return T_B_D_; }
  // Why something is not used, or what contradicts the camera; empty if all is well.
  std::string problem() const;

 private:
  RobotMotionParameters parameters_;
  WheelOdometry odometry_;
  Gyroscope gyroscope_;
  Gravity gravity_;
  OdometryWatch watch_;
  std::optional<Pose> T_B_D_;
  double asked_s_ = 0.0, asked_before_s_ = 0.0;
  std::optional<Pose> odometry_motion_;  // to the frame that was asked for last
  std::optional<StampedPose> tracked_;   // the frame that was found last
};

}  // namespace depth_fusion
