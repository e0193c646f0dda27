// Walks through a building.
#include "tools/simulation/building_plan.h"
#include "tools/simulation/scenes.h"

namespace depth_fusion {
namespace {

using Eigen::Vector2d;

// Adds the way from a corridor at y_m through the door at x_m, round the room's middle and back.
void visit(std::vector<Vector2d>& way, double x_m, double y_m, bool inner) {
  const double out = (y_m > 0.0) == inner ? -1.0 : 1.0;
  const double near_m = inner ? 2.8 : 3.05, far_m = near_m + (inner ? 2.4 : 3.4), half_m = inner ? 2.2 : 2.4;
  way.insert(way.end(), {{x_m, y_m},
                         {x_m, y_m + out * near_m},
                         {x_m + half_m, y_m + out * near_m},
                         {x_m + half_m, y_m + out * far_m},
                         {x_m - half_m, y_m + out * far_m},
                         {x_m - half_m, y_m + out * near_m},
                         {x_m, y_m + out * near_m},
                         {x_m, y_m}});
}

constexpr double kNorth_m = 6.75, kSouth_m = -6.75, kWest_m = -28.75, kEast_m = 28.75;

Walk tour() {
  std::vector<Vector2d> way = {{0, 0}, {0, kNorth_m}};
  visit(way, kOuterDoor_m[4], kNorth_m, false);
  way.insert(way.end(), {{kEast_m, kNorth_m}, {kEast_m, kSouth_m}, {0, kSouth_m}});
  return walkAlong("tour", "100 m in 170 s: the hall, half the ring and a room", way);
}

Walk loop() {
  std::vector<Vector2d> way = {{-10, kNorth_m}};
  visit(way, kOuterDoor_m[3], kNorth_m, false);
  visit(way, kOuterDoor_m[4], kNorth_m, false);
  visit(way, kInnerDoor_m[5], kNorth_m, true);
  way.insert(way.end(), {{kEast_m, kNorth_m}, {kEast_m, kSouth_m}});
  visit(way, kOuterDoor_m[4], kSouth_m, false);
  visit(way, kInnerDoor_m[2], kSouth_m, true);
  visit(way, kOuterDoor_m[0], kSouth_m, false);
  way.insert(way.end(), {{kWest_m, kSouth_m}, {kWest_m, kNorth_m}});
  visit(way, kInnerDoor_m[0], kNorth_m, true);
  visit(way, kOuterDoor_m[1], kNorth_m, false);
  return walkAlong("loop", "280 m in 470 s: the ring, eight rooms, the two alike among them", way);
}

Walk laps() {
  return walkAlong(
      "laps", "140 m in 234 s: the ring of corridors",
      {{-10, kNorth_m}, {kEast_m, kNorth_m}, {kEast_m, kSouth_m}, {kWest_m, kSouth_m}, {kWest_m, kNorth_m}});
}

Walk drive() {
  std::vector<Vector2d> way = {{0, kNorth_m}};
  visit(way, kOuterDoor_m[4], kNorth_m, false);
  way.insert(way.end(), {{kEast_m, kNorth_m}, {kEast_m, kSouth_m}});
  visit(way, kOuterDoor_m[4], kSouth_m, false);
  way.insert(way.end(), {{0, kSouth_m}});
  return driveAlong("drive", "a robot: half the ring of corridors and two rooms", way);
}

}  // namespace

SimulatedScene makeBuildingScene() {
  return sceneWithWalks(build(buildingRooms(), buildingDoorways()), {tour(), loop(), laps(), drive()});
}

}  // namespace depth_fusion
