// Flat surfaces without end: along them geometry says nothing, and only the texture shows the motion.
#include <cmath>

#include "depth_fusion/geometry/angles.h"
#include "tools/simulation/scenes.h"

namespace depth_fusion {
namespace {

using Eigen::Vector3d;

constexpr double kWalk_m_s = 0.3;
constexpr double kWallY_m = 1.0;

const Material kPlaster{{125, 140, 150}, Pattern::kMottle, 0.16, 0.5};
const Material kCarpet{{110, 105, 135}, Pattern::kMottle, 0.2, 0.5};

Primitive wall() { return plane({0, kWallY_m, 0}, {0, -1, 0}, kPlaster); }

// The camera walks along x from x = -1.5 m, 3 m in 10 s, and faces the wall with the given pitch.
Gaze alongWall(const Sway& walk, const Sway& look, const Vector3d& eye_W, double pitch_deg) {
  Gaze gaze;
  gaze.eye_W = eye_W + Vector3d(kWalk_m_s * walk.time_s() - 1.5 + 0.04 * walk(0, 4.0), 0.04 * walk(1, 5.0),
                                0.03 * walk(2, 3.5));
  const double yaw_rad = 4.0 * look(3, 4.5) * kRadPerDeg;
  const double pitch_rad = (pitch_deg + 3.0 * look(4, 3.7)) * kRadPerDeg;
  gaze.target_W = gaze.eye_W + Vector3d(std::sin(yaw_rad), std::cos(yaw_rad), std::tan(pitch_rad));
  gaze.roll_rad = 3.0 * look(5, 4.1) * kRadPerDeg;
  return gaze;
}

Gaze wallGaze(const Sway& walk, const Sway& look) { return alongWall(walk, look, {0, 0, 1.2}, 0.0); }

Gaze floorWallGaze(const Sway& walk, const Sway& look) {
  return alongWall(walk, look, {0, -0.2, 1.1}, -35.0);
}

}  // namespace

SimulatedScene makeWallScene() { return {Scene({wall()}), kinectSensor(), wallGaze}; }

SimulatedScene makeFloorWallScene() {
  return {Scene({plane({0, 0, 0}, {0, 0, 1}, kCarpet), wall()}), kinectSensor(), floorWallGaze};
}

}  // namespace depth_fusion
