// How far the sensor may have moved along directions that nothing measures.
#pragma once

#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

class GuessedMotion {
 public:
  // The frame's pose is measured in all directions; the sensor has got there at this velocity (rotation in
  // rad/s, translation in m/s), which is zero where nothing says how fast it is.
  void measure(double stamp_s, const Vector6d& velocity);
  // The frame's pose is guessed along some; what was measured of the velocity says how fast the sensor is.
  void guess(double stamp_s, const Vector6d& velocity);

  // Whether the pose may be a wrong one by now.
  bool isTooFar() const;
  // Whether a place that looks alike may be nearer by now than the one where it was measured.
  bool isAnywhere() const;
  double m() const { return m_; }
  double rad() const { return rad_; }

 private:
  double last_s_ = 0.0;
  Vector6d velocity_ = Vector6d::Zero();  // when it was measured last
  double m_ = 0.0, rad_ = 0.0;            // since then
};

}  // namespace depth_fusion
