// The direction of gravity by an accelerometer, carried on by the gyroscope beside it.
#pragma once

#include <optional>

#include "depth_fusion/frames/motion_readings.h"

namespace depth_fusion {

class Gravity {
 public:
  // A reading without a force, or whose force is not about that of gravity, turns the direction only.
  void add(const ImuReading& reading, const Eigen::Vector3d& gyroscope_bias_rad_s);
  // The unit vector against gravity at the last reading; none before there were some.
  std::optional<Eigen::Vector3d> up_D() const;

 private:
  Eigen::Vector3d force_D_ = Eigen::Vector3d::Zero();  // its mean
  int readings_ = 0;
  std::optional<double> last_s_;
};

}  // namespace depth_fusion
