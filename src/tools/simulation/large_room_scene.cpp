// A furnished room of 8 x 6 m, whose far side is as far as most sensors see.
#include <cmath>

#include "depth_fusion/geometry/angles.h"
#include "tools/simulation/floor_plan.h"
#include "tools/simulation/scenes.h"

namespace depth_fusion {
namespace {

Gaze largeRoomGaze(const Sway& walk, const Sway& look) {
  Gaze gaze;
  gaze.eye_W = {2.2 * walk(0, 11.0), 1.2 * walk(1, 9.0), 1.5 + 0.1 * walk(2, 7.0)};
  const double yaw_rad = (25.0 * look.time_s() + 15.0 * look(3, 8.0)) * kRadPerDeg;
  const double pitch_rad = (-14.0 + 8.0 * look(4, 6.0)) * kRadPerDeg;
  gaze.target_W = gaze.eye_W + Eigen::Vector3d(std::cos(yaw_rad), std::sin(yaw_rad), std::tan(pitch_rad));
  return gaze;
}

}  // namespace

SimulatedScene makeLargeRoomScene() {
  const Finish finish{{{185, 195, 200}, Pattern::kSpeckles, 0.3, 0.35},
                      {{90, 120, 150}, Pattern::kWood, 0.2, 0.4},
                      {{200, 200, 200}, Pattern::kSpeckles, 0.4, 0.2}};
  const std::vector<Piece> furniture = {
      {"rug", 0, 0, 0},           {"table", -2.0, 1.2, 20},   {"chair", -2.6, 0.5, 60},
      {"chair", -1.2, 0.6, 130},  {"sofa", 2.2, -2.3, 90},    {"desk", 3.2, 1.0, 180},
      {"shelf", -3.7, -1.5, 0},   {"shelf", -3.7, -0.2, 0},   {"cabinet", 1.0, 2.7, -90},
      {"locker", -1.0, 2.7, -90}, {"plant", 3.4, 2.4, 0},     {"plant", -3.4, 2.4, 0},
      {"bench", -1.5, -2.5, 90},  {"crate", 1.2, 0.6, 30},    {"crate", -0.6, -1.4, 70},
      {"bin", 3.6, -1.2, 180},    {"picture", 0.2, -2.9, 90}, {"picture", 3.9, -0.2, 180},
      {"lamp", -1.5, 0.3, 30},    {"lamp", 1.5, -0.4, 75}};
  return {Scene(build({{{-4, -3, 4, 3}, finish, furniture}}, {})), kinectSensor(), largeRoomGaze};
}

}  // namespace depth_fusion
