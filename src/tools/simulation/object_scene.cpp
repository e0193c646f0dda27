// A small figure on a table top at z = 0, with a few small things around it.
#include <cmath>

#include "depth_fusion/geometry/angles.h"
#include "tools/simulation/scenes.h"

namespace depth_fusion {
namespace {

std::vector<Primitive> figure() {
  const Material body{{70, 120, 190}, Pattern::kSpeckles, 0.02, 0.6};
  const Material limbs{{150, 110, 70}, Pattern::kTiles, 0.015, 0.6};
  return {
      cylinder({0, 0, -0.01}, {0, 0, 0.025}, 0.055, {{110, 110, 110}, Pattern::kTiles, 0.015, 0.6}),
      capsule({-0.025, 0, 0.02}, {-0.022, 0, 0.07}, 0.015, limbs),
      capsule({0.025, 0.005, 0.02}, {0.022, 0, 0.07}, 0.015, limbs),
      sphere({0, 0, 0.1}, 0.045, body),
      sphere({0.005, 0.01, 0.155}, 0.03, {{130, 170, 220}, Pattern::kSpeckles, 0.012, 0.5}),
      capsule({0.035, 0, 0.12}, {0.075, 0.035, 0.15}, 0.011, limbs),
      capsule({-0.035, 0, 0.12}, {-0.07, 0.02, 0.075}, 0.011, limbs),
      sphere({0.08, 0.04, 0.155}, 0.02, {{60, 60, 200}, Pattern::kTiles, 0.01, 0.7}),
      box({0, -0.045, 0.105}, {0.05, 0.04, 0.06}, {{80, 160, 80}, Pattern::kTiles, 0.015, 0.7}, 0.2, 0.005),
      cylinder({0.005, 0.01, 0.172}, {0.005, 0.01, 0.2}, 0.02, {{170, 70, 120}, Pattern::kTiles, 0.01, 0.7}),
  };
}

std::vector<Primitive> tableWithThings() {
  return {
      box({0, 0, -0.02}, {0.64, 0.56, 0.04}, {{120, 150, 180}, Pattern::kTiles, 0.03, 0.5}),
      box({0.14, 0.06, 0.015}, {0.05, 0.04, 0.04}, {{190, 120, 80}, Pattern::kTiles, 0.015, 0.7}, 0.5),
      box({-0.13, -0.09, 0.01}, {0.09, 0.06, 0.03}, {{80, 90, 190}, Pattern::kSpeckles, 0.02, 0.7}, -0.4),
      cylinder({-0.1, 0.12, -0.01}, {-0.1, 0.12, 0.05}, 0.02, {{90, 180, 200}, Pattern::kTiles, 0.012, 0.7}),
      sphere({0.09, -0.12, 0.018}, 0.02, {{200, 190, 90}, Pattern::kSpeckles, 0.012, 0.7}),
      capsule({0.0, 0.15, 0.01}, {0.07, 0.17, 0.01}, 0.012, {{150, 80, 160}, Pattern::kTiles, 0.012, 0.7}),
      box({0.02, -0.2, 0.03}, {0.12, 0.05, 0.08}, {{170, 170, 90}, Pattern::kTiles, 0.02, 0.7}, 0.3, 0.004),
      box({0.23, -0.02, 0.035}, {0.05, 0.1, 0.09}, {{90, 170, 120}, Pattern::kSpeckles, 0.02, 0.7}, -0.2,
          0.004),
      cylinder({-0.22, -0.12, -0.01}, {-0.22, -0.12, 0.09}, 0.035,
               {{180, 100, 120}, Pattern::kTiles, 0.02, 0.7}),
      sphere({-0.04, 0.21, 0.035}, 0.04, {{120, 120, 200}, Pattern::kTiles, 0.02, 0.7}),
      box({0.17, 0.18, 0.03}, {0.07, 0.07, 0.08}, {{200, 150, 90}, Pattern::kTiles, 0.02, 0.7}, 0.7),
      sphere({-0.17, 0.03, 0.02}, 0.025, {{90, 130, 220}, Pattern::kTiles, 0.015, 0.7}),
  };
}

// The camera goes once around the figure in 14 s, 0.3 to 0.6 m away from it.
Gaze objectGaze(const Sway& walk, const Sway& look) {
  const double bearing_rad = (25.0 * walk.time_s() + 10.0 * walk(0, 7.0)) * kRadPerDeg;
  const double radius_m = 0.36 + 0.06 * walk(1, 6.0);
  Gaze gaze;
  gaze.eye_W = {radius_m * std::cos(bearing_rad), radius_m * std::sin(bearing_rad),
                0.27 + 0.07 * walk(2, 5.0)};
  gaze.target_W = {0.01 * look(3, 4.0), 0.01 * look(4, 5.0), 0.07};
  return gaze;
}

}  // namespace

SimulatedScene makeObjectScene() {
  std::vector<Primitive> solids = tableWithThings();
  for (const Primitive& part : figure()) solids.push_back(part);
  return {Scene(std::move(solids)), precisionSensor(), objectGaze};
}

}  // namespace depth_fusion
