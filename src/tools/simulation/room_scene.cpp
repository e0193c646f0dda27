// A living room, 4 x 3 x 2.5 m about the origin of the floor. The middle above 0.95 m is left free for the
// camera.
#include <cmath>

#include "depth_fusion/geometry/angles.h"
#include "tools/simulation/scenes.h"

namespace depth_fusion {
namespace {

using Eigen::Vector3d;
using Solids = std::vector<Primitive>;

const Material kWoodDark{{45, 75, 120}, Pattern::kWood, 0.12, 0.45};
const Material kWoodLight{{110, 160, 200}, Pattern::kWood, 0.10, 0.35};
const Material kFabric{{120, 90, 60}, Pattern::kTiles, 0.12, 0.6};
const Material kStone{{140, 150, 150}, Pattern::kSpeckles, 0.08, 0.5};

void addShell(Solids& solids) {
  solids.push_back(plane({0, 0, 0}, {0, 0, 1}, {{95, 130, 165}, Pattern::kWood, 0.25, 0.45}));
  solids.push_back(room({0, 0, 1.2}, {4.0, 3.0, 2.6}, {{170, 190, 195}, Pattern::kSpeckles, 0.35, 0.35}));
  solids.push_back(box({0.2, 0.1, 0}, {2.4, 1.7, 0.04}, {{70, 70, 150}, Pattern::kTiles, 0.18, 0.7}));
  solids.push_back(box({0, 0.7, 2.45}, {4.2, 0.2, 0.3}, kWoodDark));
  solids.push_back(box({0, -0.8, 2.45}, {4.2, 0.2, 0.3}, kWoodDark));
  solids.push_back(sphere({0.3, -0.05, 2.4}, 0.16, {{180, 220, 230}, Pattern::kSpeckles, 0.1, 0.3}));
  for (const double x : {-1.55, -0.3, 0.95}) {
    solids.push_back(cylinder({x, 1.5, -0.1}, {x, 1.5, 2.6}, 0.12, kStone));
    solids.push_back(cylinder({x, -1.5, -0.1}, {x, -1.5, 2.6}, 0.12, kStone));
  }
  solids.push_back(cylinder({1.85, 1.35, -0.1}, {1.85, 1.35, 2.6}, 0.18, kStone));
}

void addWallDecoration(Solids& solids) {
  solids.push_back(box({-0.9, 1.5, 1.5}, {0.8, 0.16, 0.65}, {{150, 120, 60}, Pattern::kTiles, 0.09, 0.9}));
  solids.push_back(box({0.35, 1.5, 1.6}, {0.6, 0.16, 0.8}, {{70, 150, 170}, Pattern::kSpeckles, 0.14, 0.9}));
  solids.push_back(box({0.3, -1.5, 1.2}, {1.0, 0.3, 0.06}, kWoodDark));
  solids.push_back(sphere({0.0, -1.4, 1.3}, 0.09, kStone));
  solids.push_back(
      box({0.5, -1.4, 1.32}, {0.2, 0.12, 0.24}, {{80, 170, 170}, Pattern::kTiles, 0.08, 0.7}, 0.3));
  solids.push_back(box({0.3, -1.5, 1.85}, {1.0, 0.16, 0.6}, {{160, 100, 130}, Pattern::kTiles, 0.11, 0.9}));
  solids.push_back(box({-0.95, -1.5, 1.5}, {0.6, 0.16, 0.5}, {{80, 160, 90}, Pattern::kSpeckles, 0.1, 0.9}));
  solids.push_back(box({2.0, -0.4, 1.75}, {0.16, 1.0, 0.9}, {{190, 150, 110}, Pattern::kTiles, 0.15, 0.8}));
  solids.push_back(
      cylinder({1.9, 0.6, 1.7}, {2.1, 0.6, 1.7}, 0.2, {{120, 170, 200}, Pattern::kTiles, 0.08, 0.7}));
}

void addTable(Solids& solids) {
  solids.push_back(box({0.3, 0.1, 0.70}, {1.2, 0.75, 0.06}, kWoodLight, 0.0, 0.01));
  for (const double x : {-0.22, 0.82}) {
    for (const double y : {-0.2, 0.4}) {
      solids.push_back(cylinder({x, y, -0.05}, {x, y, 0.69}, 0.035, kWoodDark));
    }
  }
  solids.push_back(sphere({0.1, 0.2, 0.79}, 0.09, {{60, 140, 220}, Pattern::kSpeckles, 0.06, 0.6}));
  solids.push_back(
      cylinder({0.55, -0.05, 0.7}, {0.55, -0.05, 0.86}, 0.055, {{190, 120, 60}, Pattern::kTiles, 0.05, 0.7}));
  solids.push_back(
      box({0.65, 0.3, 0.76}, {0.28, 0.2, 0.08}, {{80, 80, 190}, Pattern::kTiles, 0.07, 0.7}, 0.4));
  solids.push_back(
      box({-0.1, -0.08, 0.75}, {0.22, 0.16, 0.06}, {{170, 170, 80}, Pattern::kSpeckles, 0.06, 0.7}, -0.3));
}

void addChair(Solids& solids, double x, double y, double yaw_deg) {
  const Eigen::Rotation2Dd turn(yaw_deg * kRadPerDeg);
  const auto at = [&](double forward, double left, double z) {
    const Eigen::Vector2d offset = turn * Eigen::Vector2d(forward, left);
    return Vector3d(x + offset.x(), y + offset.y(), z);
  };
  solids.push_back(box(at(0, 0, 0.43), {0.42, 0.42, 0.06}, kFabric, turn.angle(), 0.01));
  solids.push_back(box(at(-0.19, 0, 0.66), {0.06, 0.40, 0.48}, kWoodDark, turn.angle(), 0.01));
  for (const double forward : {-0.17, 0.17}) {
    for (const double left : {-0.17, 0.17}) {
      solids.push_back(cylinder(at(forward, left, -0.05), at(forward, left, 0.42), 0.03, kWoodDark));
    }
  }
}

void addSofa(Solids& solids) {
  const Material cover{{60, 110, 80}, Pattern::kTiles, 0.15, 0.6};
  const Material cushion{{70, 130, 210}, Pattern::kSpeckles, 0.1, 0.7};
  solids.push_back(box({-0.2, -1.15, 0.2}, {1.7, 0.8, 0.44}, cover, 0.0, 0.03));
  solids.push_back(box({-0.2, -1.42, 0.4}, {1.7, 0.26, 0.84}, cover, 0.0, 0.05));
  for (const double x : {-1.0, 0.6})
    solids.push_back(box({x, -1.15, 0.3}, {0.2, 0.82, 0.64}, cover, 0.0, 0.05));
  solids.push_back(capsule({-0.75, -1.15, 0.5}, {-0.4, -1.15, 0.5}, 0.1, cushion));
  solids.push_back(sphere({0.25, -1.1, 0.52}, 0.13, cushion));
}

void addShelf(Solids& solids) {
  solids.push_back(box({-2.0, 0.3, 0.9}, {0.1, 1.3, 1.84}, kWoodDark));
  for (const double y : {-0.33, 0.93}) solids.push_back(box({-1.84, y, 0.9}, {0.36, 0.06, 1.9}, kWoodDark));
  for (const double z : {0.1, 0.65, 1.2, 1.8}) {
    solids.push_back(box({-1.84, 0.3, z}, {0.36, 1.28, 0.06}, kWoodDark));
  }
  int book = 0;
  for (const double z : {0.12, 0.67, 1.22}) {
    for (double y = -0.22; y < 0.2; y += 0.1, ++book) {
      const double height_m = 0.26 + 0.05 * (book * 7 % 4);
      const Material cover{{60.0 + book * 53 % 160, 60.0 + book * 97 % 150, 60.0 + book * 31 % 170},
                           Pattern::kTiles,
                           0.06,
                           0.5};
      solids.push_back(box({-1.84 + 0.01 * (book % 3), y, z + height_m / 2}, {0.22, 0.085, height_m}, cover));
    }
    solids.push_back(cylinder({-1.82, 0.65, z}, {-1.82, 0.65, z + 0.3}, 0.09, kStone));
  }
}

void addCabinet(Solids& solids) {
  solids.push_back(box({1.8, -0.4, 0.4}, {0.45, 1.2, 0.86}, kWoodLight, 0.0, 0.01));
  for (const double y : {-0.7, -0.1}) {
    solids.push_back(sphere({1.57, y, 0.55}, 0.04, kStone));
    solids.push_back(box({1.58, y, 0.3}, {0.06, 0.4, 0.2}, kWoodDark));
  }
  solids.push_back(sphere({1.8, -0.75, 0.95}, 0.14, {{200, 140, 90}, Pattern::kTiles, 0.06, 0.7}));
  solids.push_back(box({1.82, -0.2, 1.0}, {0.2, 0.5, 0.4}, {{90, 90, 95}, Pattern::kTiles, 0.1, 0.8}, 0.3));
}

void addLooseThings(Solids& solids) {
  solids.push_back(capsule({1.55, -1.2, 0}, {1.55, -1.2, 1.5}, 0.04, kStone));
  solids.push_back(sphere({1.55, -1.2, 1.6}, 0.17, {{150, 210, 230}, Pattern::kSpeckles, 0.12, 0.4}));
  solids.push_back(sphere({-1.2, -0.55, 0.2}, 0.2, {{50, 120, 200}, Pattern::kTiles, 0.1, 0.8}));
  solids.push_back(box({-1.6, -1.2, 0.2}, {0.45, 0.4, 0.5}, kWoodLight, 0.5));
  solids.push_back(
      cylinder({0.2, 1.3, -0.1}, {0.2, 1.3, 0.6}, 0.15, {{60, 90, 170}, Pattern::kSpeckles, 0.1, 0.6}));
  solids.push_back(sphere({0.2, 1.3, 0.8}, 0.23, {{60, 150, 70}, Pattern::kSpeckles, 0.06, 0.9}));
  solids.push_back(box({-1.1, 1.3, 0.3}, {0.9, 0.4, 0.65}, kFabric, 0.0, 0.02));
  solids.push_back(
      box({-1.25, 1.3, 0.72}, {0.3, 0.25, 0.24}, {{150, 60, 150}, Pattern::kTiles, 0.08, 0.7}, 0.6));
  solids.push_back(box({1.75, 0.65, 0.2}, {0.4, 0.45, 0.5}, kFabric, 0.2));
  solids.push_back(sphere({1.75, 0.65, 0.6}, 0.18, {{200, 120, 160}, Pattern::kTiles, 0.08, 0.7}));
  solids.push_back(
      cylinder({0.85, 1.3, -0.1}, {0.85, 1.3, 0.75}, 0.12, {{90, 160, 200}, Pattern::kTiles, 0.1, 0.7}));
  solids.push_back(box({1.3, 1.2, 0.15}, {0.4, 0.35, 0.4}, {{60, 160, 180}, Pattern::kTiles, 0.1, 0.7}, 0.3));
}

// The camera walks about the middle at 0.3 m/s and looks around at 25 deg/s, once around in 14 s.
Gaze roomGaze(const Sway& walk, const Sway& look) {
  Gaze gaze;
  gaze.eye_W = {0.8 * walk(0, 13.0), 0.4 * walk(1, 9.0), 1.55 + 0.1 * walk(2, 7.0)};
  const double yaw_rad = (25.0 * look.time_s() + 20.0 * look(3, 8.0)) * kRadPerDeg;
  const double pitch_rad = (-28.0 + 7.0 * look(4, 6.0)) * kRadPerDeg;
  gaze.target_W = gaze.eye_W + Vector3d(std::cos(pitch_rad) * std::cos(yaw_rad),
                                        std::cos(pitch_rad) * std::sin(yaw_rad), std::sin(pitch_rad));
  return gaze;
}

Solids furnishedRoom() {
  Solids solids;
  addShell(solids);
  addWallDecoration(solids);
  addTable(solids);
  addChair(solids, 0.1, 0.85, -80.0);
  addChair(solids, 1.15, 0.0, 170.0);
  addChair(solids, 0.2, -0.5, 75.0);
  addSofa(solids);
  addShelf(solids);
  addCabinet(solids);
  addLooseThings(solids);
  return solids;
}

SimulatedScene sceneOf(Solids solids) {
  SimulatedScene scene{Scene(std::move(solids)), kinectSensor(), roomGaze};
  scene.looks_around = true;
  return scene;
}

}  // namespace

SimulatedScene makeRoomScene() { return sceneOf(furnishedRoom()); }

SimulatedScene makeWhiteRoomScene() {
  Material white{{225, 225, 225}, Pattern::kPlain};
  white.shaded = false;
  Solids solids = furnishedRoom();
  for (Primitive& solid : solids) solid.paint(white);
  return sceneOf(std::move(solids));
}

}  // namespace depth_fusion
