// A room in which the same is to be seen again and again.
#include <cmath>

#include "depth_fusion/geometry/angles.h"
#include "tools/simulation/floor_plan.h"
#include "tools/simulation/scenes.h"

namespace depth_fusion {
namespace {

using Eigen::Vector3d;
using Solids = std::vector<Primitive>;

// Lamps, shelves and what stands on them are the same again and again, and so are the tiles of the floor.
Solids alikeEverywhere() {
  const Finish finish{{{190, 200, 205}, Pattern::kPlain},
                      {{150, 150, 150}, Pattern::kRepeated, 0.4, 0.4},
                      {{120, 120, 120}, Pattern::kPlain}};
  Solids solids = build({{{-4, -3, 4, 3}, finish, {}}}, {});
  const auto add = [&](const char* kind, double x_m, double y_m, double yaw_deg) {
    Pose T_W_P(Eigen::AngleAxisd(yaw_deg * kRadPerDeg, Vector3d::UnitZ()));
    T_W_P.pretranslate(Vector3d(x_m, y_m, 0.0));
    addPiece(kind, T_W_P, 0, solids);
  };
  for (double x_m = -3.2; x_m < 3.5; x_m += 0.8) {
    for (double y_m = -2.1; y_m < 2.5; y_m += 1.4) add("lamp", x_m, y_m, 0.0);
  }
  for (double x_m = -3.2; x_m < 3.5; x_m += 1.25) {
    add("shelf", x_m, 2.9, -90.0);
    add("shelf", x_m, -2.9, 90.0);
  }
  for (const double y_m : {-1.2, 0.0, 1.2}) {
    add("shelf", -3.9, y_m, 0.0);
    add("shelf", 3.9, y_m, 180.0);
  }
  for (Primitive& solid : solids) {
    Material material = solid.material();
    if (material.pattern == Pattern::kPlain) continue;
    material.pattern = Pattern::kRepeated;
    solid.paint(material);
  }
  return solids;
}

// The camera looks at where wall and ceiling meet.
Gaze alikeGaze(const Sway& walk, const Sway& look) {
  Gaze gaze;
  gaze.eye_W = {1.2 * walk(0, 11.0), 0.8 * walk(1, 9.0), 1.45 + 0.1 * walk(2, 7.0)};
  const double yaw_rad = (15.0 * look.time_s() + 20.0 * look(3, 8.0)) * kRadPerDeg;
  const double pitch_rad = (12.0 + 7.0 * look(4, 6.0)) * kRadPerDeg;
  gaze.target_W = gaze.eye_W + Vector3d(std::cos(yaw_rad), std::sin(yaw_rad), std::tan(pitch_rad));
  return gaze;
}

}  // namespace

SimulatedScene makeAlikeScene() {
  SimulatedScene scene{Scene(alikeEverywhere()), kinectSensor(), alikeGaze};
  scene.sensor.color = videoCamera();
  return scene;
}

}  // namespace depth_fusion
