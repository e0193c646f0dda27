// What defeats trackers: things that move, mirrors and glass, walls from close by, fast shakes. A video
// camera gives the colour.
#include <algorithm>
#include <cmath>

#include "depth_fusion/geometry/angles.h"
#include "tools/simulation/scenes.h"

namespace depth_fusion {
namespace {

using Eigen::Vector3d;
using Solids = std::vector<Primitive>;

constexpr double kTwoPi = 6.283185307179586;

SimulatedScene seenByVideo(SimulatedScene scene) {
  scene.sensor.color = videoCamera();
  return scene;
}

// Grows smoothly from 0 to 1 between two times.
double ramp(double time_s, double from_s, double to_s) {
  const double share = std::clamp((time_s - from_s) / (to_s - from_s), 0.0, 1.0);
  return share * share * (3.0 - 2.0 * share);
}

Vector3d direction(double yaw_rad, double pitch_rad) {
  return {std::cos(pitch_rad) * std::cos(yaw_rad), std::cos(pitch_rad) * std::sin(yaw_rad),
          std::sin(pitch_rad)};
}

// Somebody who stands at the origin of P and looks along x, in the middle of a step.
Solids person(double phase_rad) {
  const Material shirt{{60, 70, 160}, Pattern::kSpeckles, 0.08, 0.6}, skin{{120, 150, 200}, Pattern::kPlain};
  const Material trousers{{110, 80, 60}, Pattern::kTiles, 0.05, 0.4};
  const double step_m = 0.25 * std::sin(phase_rad);
  return {capsule({0, 0, 0.95}, {0, 0, 1.4}, 0.22, shirt),
          sphere({0, 0, 1.68}, 0.12, skin),
          capsule({0, 0.27, 1.42}, {step_m, 0.32, 0.95}, 0.07, shirt),
          capsule({0, -0.27, 1.42}, {-step_m, -0.32, 0.95}, 0.07, shirt),
          capsule({0, 0.1, 0.9}, {-step_m, 0.1, 0.08}, 0.09, trousers),
          capsule({0, -0.1, 0.9}, {step_m, -0.1, 0.08}, 0.09, trousers)};
}

// Walks into the view from the right, stays before the camera wherever that looks, and leaves to the left.
Solids personBefore(const Pose& T_W_D, double time_s) {
  constexpr double kRange_m = 0.75, kOutside_rad = 1.2;
  if (time_s < 1.0 || time_s > 4.0) return {};
  const Vector3d forward = T_W_D.linear().col(2);
  const double bearing_rad = std::atan2(forward.y(), forward.x()) + 0.1 * std::sin(kTwoPi * time_s) +
                             kOutside_rad * (ramp(time_s, 1.0, 2.0) - 1.0 + ramp(time_s, 3.0, 4.0));
  Pose T_W_P(Eigen::AngleAxisd(bearing_rad, Vector3d::UnitZ()));
  T_W_P.pretranslate(Vector3d(T_W_D.translation().x() + kRange_m * std::cos(bearing_rad),
                              T_W_D.translation().y() + kRange_m * std::sin(bearing_rad), 0.0));
  Solids solids;
  for (const Primitive& part : person(kTwoPi * time_s)) solids.push_back(part.moved(T_W_P));
  return solids;
}

// The camera looks to and fro over one side of the room.
Gaze oneSideGaze(const Sway& walk, const Sway& look) {
  Gaze gaze;
  gaze.eye_W = {0.3 * walk(0, 13.0), 0.3 * walk(1, 9.0), 1.55 + 0.1 * walk(2, 7.0)};
  gaze.target_W = gaze.eye_W + direction((60.0 + 8.0 * look(3, 4.0)) * kRadPerDeg,
                                         (-28.0 + 7.0 * look(4, 6.0)) * kRadPerDeg);
  return gaze;
}

// Slides over the lens at 1 s and away again at 1.6 s.
Solids handBefore(const Pose& T_W_D, double time_s) {
  if (time_s < 1.0 || time_s > 1.8) return {};
  const Material skin{{70, 90, 130}, Pattern::kSpeckles, 0.03, 0.2};
  const Vector3d at_D(0.25 * (1.0 - ramp(time_s, 1.0, 1.2) + ramp(time_s, 1.6, 1.8)), 0.0, 0.12);
  return {box(at_D, {0.26, 0.22, 0.03}, skin).moved(T_W_D)};
}

// Things that turn on the table, once in 12 s.
Solids turningThings(const Pose&, double time_s) {
  Pose T_W_table(Eigen::AngleAxisd(30.0 * kRadPerDeg * time_s, Vector3d::UnitZ()));
  T_W_table.pretranslate(Vector3d(0.45, 0.1, 0.73));
  const Solids things = {
      box({0, 0, 0.16}, {0.46, 0.3, 0.32}, {{70, 120, 190}, Pattern::kTiles, 0.06, 0.6}),
      cylinder({0.1, 0.05, 0.3}, {0.1, 0.05, 0.62}, 0.1, {{150, 110, 70}, Pattern::kSpeckles, 0.05, 0.6}),
      sphere({-0.12, -0.02, 0.4}, 0.12, {{90, 170, 120}, Pattern::kTiles, 0.04, 0.7})};
  Solids solids;
  for (const Primitive& thing : things) solids.push_back(thing.moved(T_W_table));
  return solids;
}

Gaze turntableGaze(const Sway& walk, const Sway& look) {
  Gaze gaze;
  gaze.eye_W = {-0.6 + 0.15 * walk(0, 6.0), -0.1 + 0.2 * walk(1, 5.0), 1.5 + 0.06 * walk(2, 4.0)};
  gaze.target_W = {0.45 + 0.06 * look(3, 4.5), 0.1 + 0.06 * look(4, 3.7), 0.95};
  return gaze;
}

Solids pane(const Vector3d& centre_W, const Vector3d& size_m, Optics optics) {
  Material material;
  material.optics = optics;
  return {box(centre_W, size_m, material)};
}

// The camera begins 0.3 m before a picture on the wall and moves back at 0.35 m/s.
Gaze backingGaze(const Sway& walk, const Sway& look) {
  Gaze gaze;
  gaze.eye_W = {1.62 - std::min(0.35 * walk.time_s(), 1.6), -0.4 + 0.03 * walk(0, 4.0),
                1.65 + 0.03 * walk(1, 3.5)};
  gaze.target_W = gaze.eye_W + Vector3d(1.0, 0.05 * look(2, 3.0), 0.05 * look(3, 3.7) - 0.1);
  return gaze;
}

// After a second the camera is shaken to and fro, at 120 deg/s at the fastest.
Gaze shakenGaze(const Sway& walk, const Sway& look) {
  constexpr double kPeriod_s = 1.0;
  const double swing_deg = 120.0 * kPeriod_s / kTwoPi * ramp(look.time_s(), 0.8, 1.6);
  const double angle = kTwoPi * look.time_s() / kPeriod_s;
  Gaze gaze;
  gaze.eye_W = {0.3 * walk(0, 13.0), 0.3 * walk(1, 9.0), 1.55 + 0.1 * walk(2, 7.0)};
  gaze.target_W = gaze.eye_W + direction((60.0 + swing_deg * std::sin(angle)) * kRadPerDeg,
                                         (-28.0 + 0.3 * swing_deg * std::sin(0.7 * angle)) * kRadPerDeg);
  return gaze;
}

}  // namespace

SimulatedScene makePersonScene() {
  SimulatedScene scene = seenByVideo(makeRoomScene());
  scene.path = oneSideGaze;
  scene.looks_around = false;
  scene.also_seen = personBefore;
  return scene;
}

SimulatedScene makeHandScene() {
  SimulatedScene scene = seenByVideo(makeRoomScene());
  scene.also_seen = handBefore;
  return scene;
}

SimulatedScene makeTurntableScene() {
  SimulatedScene scene = seenByVideo(makeRoomScene());
  scene.path = turntableGaze;
  scene.looks_around = false;
  scene.also_seen = turningThings;
  return scene;
}

SimulatedScene makeMirrorScene() {
  SimulatedScene scene = seenByVideo(makeRoomScene());
  scene.also_seen = [](const Pose&, double) {
    return pane({0.0, 1.33, 1.4}, {1.8, 0.04, 1.3}, Optics::kMirror);
  };
  return scene;
}

SimulatedScene makeGlassScene() {
  SimulatedScene scene = seenByVideo(makeRoomScene());
  scene.also_seen = [](const Pose&, double) {
    return pane({0.0, 0.95, 1.3}, {3.9, 0.02, 2.4}, Optics::kGlass);
  };
  return scene;
}

SimulatedScene makeBackingScene() {
  SimulatedScene scene = seenByVideo(makeRoomScene());
  scene.path = backingGaze;
  scene.looks_around = false;
  return scene;
}

SimulatedScene makeShakenScene() {
  SimulatedScene scene = seenByVideo(makeRoomScene());
  scene.sensor.readout_s = 0.03;
  scene.path = shakenGaze;
  scene.looks_around = false;
  return scene;
}

}  // namespace depth_fusion
