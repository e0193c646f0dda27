// Whether odometry contradicts the camera for long, and why.
#pragma once

#include <deque>
#include <string>

#include "depth_fusion/geometry/pose.h"
#include "depth_fusion/robot_motion/robot_motion_parameters.h"

namespace depth_fusion {

// The motion from one frame to the next as both have it, between depth camera frames.
struct ComparedMotion {
  double stamp_s = 0.0;  // of the later frame
  double interval_s = 0.0;
  Pose by_camera = Pose::Identity(), by_odometry = Pose::Identity();
};

class OdometryWatch {
 public:
  void add(const ComparedMotion& motion, const RobotMotionParameters& parameters);
  void reset() { *this = {}; }
  // What is wrong with odometry in words, with what would put it right: the offset of its stamps, or the
  // camera's rotation on the robot, where one of them explains it; empty if nothing is, or nothing is known.
  const std::string& problem() const { return problem_; }

 private:
  std::string cause() const;

  std::deque<ComparedMotion> motions_;
  int in_doubt_ = 0;  // how many more comparisons contradict than agree
  std::string problem_;
};

}  // namespace depth_fusion
