// A round column on an endless floor. The floor fixes height and tilt, the column where the camera stands,
// and nothing but texture shows the turn about the column's axis.
#include <cmath>

#include "depth_fusion/geometry/angles.h"
#include "tools/simulation/scenes.h"

namespace depth_fusion {
namespace {

constexpr double kWalk_m_s = 0.3;
constexpr double kOrbit_m = 1.3;

// The camera walks around the column, 3 m in 10 s, and looks at its foot.
Gaze cylinderGaze(const Sway& walk, const Sway& look) {
  const double bearing_rad = (kWalk_m_s * walk.time_s() + 0.04 * walk(0, 4.0)) / kOrbit_m;
  const double orbit_m = kOrbit_m + 0.03 * walk(1, 5.0);
  Gaze gaze;
  gaze.eye_W = {orbit_m * std::cos(bearing_rad), orbit_m * std::sin(bearing_rad), 1.5 + 0.03 * walk(2, 3.5)};
  gaze.target_W = {0.06 * look(3, 4.5), 0.06 * look(4, 3.7), 0.35 + 0.06 * look(5, 4.3)};
  gaze.roll_rad = 3.0 * look(6, 4.1) * kRadPerDeg;
  return gaze;
}

}  // namespace

SimulatedScene makeCylinderScene() {
  const Material stone{{135, 145, 140}, Pattern::kMottle, 0.16, 0.5};
  const Material carpet{{110, 105, 135}, Pattern::kMottle, 0.3, 0.5};
  return {Scene({plane({0, 0, 0}, {0, 0, 1}, carpet), cylinder({0, 0, -0.1}, {0, 0, 2.6}, 0.4, stone)}),
          kinectSensor(), cylinderGaze};
}

}  // namespace depth_fusion
