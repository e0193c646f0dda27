// How a camera held in the hand moves.
#pragma once

#include <functional>

#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

// Gives smooth, quasi-periodic motion that depends on the seed alone.
class Sway {
 public:
  Sway(unsigned seed, double time_s) : seed_(seed), time_s_(time_s) {}

  double time_s() const { return time_s_; }
  // A value in [-1, 1] that swings with about the given period; channels are independent of each other.
  double operator()(int channel, double period_s) const;

 private:
  unsigned seed_;
  double time_s_;
};

struct Gaze {
  Eigen::Vector3d eye_W;
  Eigen::Vector3d target_W;  // on the optical axis
  double roll_rad = 0.0;     // about the optical axis; 0: upright
};

// Says where the camera is and what it looks at. Walking and looking around have a time each, so that either
// can be sped up alone.
using GazePath = std::function<Gaze(const Sway& walk, const Sway& look)>;

// Speeds are factors on the path's own.
struct HandSpeed {
  double walk = 1.0;
  double look = 1.0;
};

// Returns the pose of a depth camera on the path, with a slight tremor of the hand, which speed leaves as it
// is; `tremor` is a factor on it.
Pose handHeldPose(const GazePath& path, unsigned seed, const HandSpeed& speed, double time_s,
                  double tremor = 1.0);

struct Rates {
  double linear_m_s = 0.0;
  double turn_rad_s = 0.0;
};

// Returns how fast the camera moves on the path at its own speed, without tremor.
Rates ratesAt(const GazePath& path, unsigned seed, double time_s);

}  // namespace depth_fusion
