// The rotation between frames by a gyroscope, whose bias is learnt from what tracking finds.
#pragma once

#include <deque>
#include <optional>

#include "depth_fusion/frames/motion_prior.h"
#include "depth_fusion/frames/motion_readings.h"
#include "depth_fusion/robot_motion/robot_motion_parameters.h"

namespace depth_fusion {

class Gyroscope {
 public:
  // A reading without a rate, or whose stamp is no news, is left out.
  void add(const ImuReading& reading);
  // The rotation since the frame asked for before; nothing is said of the translation. None if a tenth of a
  // second or more of the readings is missing.
  std::optional<FrameMotion> motionTo(double stamp_s, const RobotMotionParameters& parameters);
  // Tracking found this rotation for the motion returned last.
  void learn(const Eigen::Matrix3d& R_previous_current, const RobotMotionParameters& parameters);

  const Eigen::Vector3d& bias_rad_s() const { return bias_rad_s_; }

 private:
  struct Rate {
    double stamp_s;
    Eigen::Vector3d rad_s;
  };
  // The rotation from one time to another, each rate from the reading before it to its own.
  std::optional<Eigen::Matrix3d> rotation(double from_s, double to_s) const;

  std::deque<Rate> rates_;
  std::optional<double> before_s_;
  double interval_s_ = 0.0;  // of the motion returned last; 0: there is none
  Eigen::Matrix3d last_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d bias_rad_s_ = Eigen::Vector3d::Zero();
  double bias_variance_;

 public:
  Gyroscope();
};

}  // namespace depth_fusion
