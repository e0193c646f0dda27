// How a camera held in the hand moves.
#pragma once

#include <functional>

#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

// Smooth, quasi-periodic motion that depends on the seed alone.
class Sway {
 public:
  Sway(unsigned seed, double time_s) : seed_(seed), time_s_(time_s) {}

  double time_s() const { return time_s_; }
  // In [-1, 1], of about the given period; channels are independent of each other.
  double operator()(int channel, double period_s) const;

 private:
  unsigned seed_;
  double time_s_;
};

struct Gaze {
  Eigen::Vector3d eye_W;
  Eigen::Vector3d target_W;  // on the optical axis
};

// Where the camera is and what it looks at, at a time.
using GazePath = std::function<Gaze(const Sway&)>;

// The pose of a depth camera on the path, upright but for a slight tremor of the hand.
Pose handHeldPose(const GazePath& path, unsigned seed, double time_s);

}  // namespace depth_fusion
