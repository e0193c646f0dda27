#include "tools/simulation/building_plan.h"

namespace depth_fusion {
namespace {

using Eigen::Vector2d;
using Furniture = std::vector<Piece>;

const Material kWhite{{215, 218, 220}, Pattern::kPlain};
const Material kCream{{185, 205, 215}, Pattern::kPlain};
const Material kPlaster{{165, 180, 190}, Pattern::kSpeckles, 0.3, 0.3};
const Material kWallpaper{{150, 165, 160}, Pattern::kTiles, 0.15, 0.35};
const Material kBrick{{95, 115, 160}, Pattern::kTiles, 0.22, 0.4};
const Material kCarpet{{110, 100, 90}, Pattern::kTiles, 0.12, 0.45};
const Material kPlanks{{95, 130, 165}, Pattern::kWood, 0.25, 0.4};
const Material kLino{{150, 150, 140}, Pattern::kPlain};
const Material kStone{{140, 145, 145}, Pattern::kTiles, 0.3, 0.3};

const Finish kPlainRoom{kWhite, kLino, kWhite};
const Finish kPapered{kWallpaper, kPlanks, kWhite};
const Finish kPlastered{kPlaster, kCarpet, kCream};
const Finish kBare{kBrick, kStone, kWhite};
const Finish kCorridor{kCream, kStone, kWhite};

// Rooms of 10 x 7 m, within 4.9 and 3.4 m of the middle, with the door at y = -3.4; the way round
// the middle, 2.4 by 1.7 m from it, is left free.
const Furniture kOffice = {{"table", 0, 0, 90},
                           {"chair", 0.4, 0.75, -85},
                           {"chair", -0.5, 0.75, -100},
                           {"chair", -0.3, -0.75, 85},
                           {"desk", -3.2, 3.4, -90, 0, 3, 3.2},
                           {"chair", -3.1, 2.6, 80, 0, 3, 3.2},
                           {"shelf", -4.9, 1.2, 0, 0, 2, 0, -2.2},
                           {"cabinet", 4.9, 0.6, 180},
                           {"locker", 4.9, -2.2, 180},
                           {"plant", 2.2, -3.4, 90},
                           {"picture", -3.0, -3.4, 90},
                           {"lamp", -2.6, 0, 0, 0, 3, 2.6}};
const Furniture kMeeting = {{"table", -0.7, 0, 90, 0, 2, 1.5},
                            {"chair", -1.0, 0.7, -90, 0, 3, 1.0},
                            {"chair", -0.8, -0.7, 90, 0, 3, 0.9},
                            {"board", 0, 3.4, -90},
                            {"cabinet", -3.6, 3.4, -90},
                            {"plant", 3.9, 3.4, -90},
                            {"picture", -4.9, -1.5, 0, 0, 3, 0, 1.5},
                            {"radiator", 4.9, -1.2, 180, 0, 2, 0, 2.4},
                            {"notice", 3.0, -3.4, 90},
                            {"lamp", -1.5, 0, 90, 0, 2, 3.0}};
const Furniture kLounge = {{"rug", 0, 0, 90},
                           {"table", 0, 0.2, 90},
                           {"sofa", -1.9, 3.4, -90},
                           {"sofa", 1.9, 3.4, -90},
                           {"sofa", -4.9, 0, 0},
                           {"plant", 4.9, 2.6, 180, 0, 2, 0, -4.6},
                           {"shelf", 4.9, 0.3, 180},
                           {"picture", -2.4, -3.4, 90},
                           {"picture", 0, 3.4, -90},
                           {"bench", 3.2, -3.4, 90},
                           {"lamp", 0, -1.2, 90, 0, 3, 0, 1.2}};
const Furniture kStore = {{"crate", -0.9, -0.2, 0, 0, 3, 0.6},
                          {"crate", -0.6, 0.45, 20, 0, 2, 0.7},
                          {"shelf", -3.9, 3.4, -90, 0, 6, 1.5},
                          {"locker", -4.9, -2.4, 0, 0, 5, 0, 0.8},
                          {"shelf", 4.9, -2.2, 180, 0, 3, 0, 1.7},
                          {"crate", -3.2, -3.4, 90, 0, 2, 0.9},
                          {"bin", 2.6, -3.4, 90},
                          {"lamp", -3, 0, 90, 0, 3, 3.0}};
// Rooms of 8.25 x 5.5 m, within 4.025 and 2.65 m; the way is 2.2 by 1.2 m from the middle.
const Furniture kStudy = {{"table", 0, 0, 90},
                          {"chair", 1.0, 0.05, 175},
                          {"chair", -1.0, 0, 5},
                          {"desk", -2.4, 2.65, -90, 0, 2, 3.6},
                          {"shelf", -4.025, 0.6, 0, 0, 2, 0, -1.8},
                          {"board", 4.025, 0, 180},
                          {"cabinet", 2.6, -2.65, 90},
                          {"picture", -2.4, -2.65, 90},
                          {"lamp", -1.6, 0, 0, 0, 2, 3.2}};
const Furniture kArchive = {{"locker", -0.45, -0.3, 90, 0, 3, 0.6},
                            {"shelf", -3.0, 2.65, -90, 0, 5, 1.45},
                            {"shelf", -4.025, -1.2, 0, 0, 2, 0, 1.6},
                            {"crate", 4.025, -1.4, 180, 0, 4, 0, 0.9},
                            {"notice", -2.4, -2.65, 90},
                            {"bin", 2.4, -2.65, 90},
                            {"lamp", 0, -1.0, 90, 0, 2, 0, 2.0}};
const Furniture kKitchen = {{"table", 0, 0, 90},
                            {"chair", -1.05, 0.1, 0},
                            {"cabinet", -3.0, 2.65, -90, 0, 4, 1.1},
                            {"locker", 2.2, 2.65, -90},
                            {"bench", 4.025, -0.6, 180},
                            {"picture", 4.025, 0.8, 180},
                            {"plant", -4.025, 1.2, 0},
                            {"radiator", -4.025, -0.8, 0},
                            {"notice", 2.4, -2.65, 90},
                            {"lamp", -1.4, 0, 90, 0, 2, 2.8}};
const Furniture kHall = {{"bench", -2.4, 2.2, 0, 0, 2, 0, -3.6},
                         {"plant", -2.4, 4.6, 0, 0, 2, 0, -9.2},
                         {"board", 2.4, 2.2, 180},
                         {"cabinet", 2.4, -1.6, 180},
                         {"picture", -2.4, 0.5, 0},
                         {"plant", 2.4, -4.4, 180},
                         {"notice", 2.4, 4.4, 180},
                         {"pillar", -2.4, -3.4, 0},
                         {"beam", 0, -3.6, 0, 0, 4, 0, 2.4},
                         {"lamp", 0, -4.8, 0, 0, 5, 0, 2.4},
                         {"sign", 0, 4.9, 90},
                         {"rug", 0, 0, 0}};
// Corridors of 60 x 2.5 m, within 1.15 m of the middle, and of 11 m; doors are 5, 6.6, 15, 23.4 and 25 m
// away.
const Furniture kLongCorridor = {{"picture", -28.2, 1.15, -90},
                                 {"bench", -22.6, 1.15, -90},
                                 {"notice", -20.4, 1.15, -90},
                                 {"radiator", -17.6, 1.15, -90},
                                 {"hydrant", -12.2, 1.15, -90},
                                 {"pillar", -9.4, 1.15, -90},
                                 {"cabinet", -7.4, 1.15, -90},
                                 {"plant", -2.6, 1.15, -90},
                                 {"picture", -0.8, 1.15, -90, 0, 2, 1.9},
                                 {"bin", 3.2, 1.15, -90},
                                 {"bench", 8.2, 1.15, -90},
                                 {"notice", 11.2, 1.15, -90},
                                 {"pillar", 12.8, 1.15, -90},
                                 {"crate", 17.4, 1.15, -90},
                                 {"picture", 19.3, 1.15, -90},
                                 {"radiator", 22.0, 1.15, -90},
                                 {"locker", 27.2, 1.15, -90},
                                 {"notice", -26.4, -1.15, 90},
                                 {"locker", -20.6, -1.15, 90},
                                 {"plant", -18.2, -1.15, 90},
                                 {"picture", -12.4, -1.15, 90},
                                 {"radiator", -10.4, -1.15, 90},
                                 {"bench", -3.8, -1.15, 90},
                                 {"pillar", 3.4, -1.15, 90},
                                 {"notice", 4.4, -1.15, 90},
                                 {"hydrant", 9.6, -1.15, 90},
                                 {"picture", 11.6, -1.15, 90},
                                 {"bin", 17.8, -1.15, 90},
                                 {"bench", 20.2, -1.15, 90},
                                 {"picture", 26.2, -1.15, 90},
                                 {"lamp", -28.4, 0, 90, 0, 19, 3.2},
                                 {"beam", -26.6, 0, 0, 0, 9, 6.7},
                                 {"sign", -14.8, 0, 0, 0, 3, 14.6}};
const Furniture kShortCorridor = {{"picture", -1.15, -3.2, 0, 0, 2, 0, 4.1},
                                  {"bench", -1.15, -0.8, 0},
                                  {"notice", 1.15, -2.6, 180},
                                  {"plant", 1.15, 2.8, 180},
                                  {"radiator", 1.15, 0.3, 180},
                                  {"pillar", -1.15, 2.9, 0},
                                  {"lamp", 0, -4.2, 0, 0, 4, 0, 2.8}};

// The rooms outside of the ring, from west to east, and those inside.
struct Fitting {
  const Finish& finish;
  const Furniture& furniture;
  int seed;
};
const Fitting kNorth[] = {{kPapered, kLounge, 1}, {kPlastered, kOffice, 7}, {kPlainRoom, kMeeting, 3},
                          {kBare, kStore, 4},     {kPlastered, kOffice, 7}, {kPlainRoom, kOffice, 5}};
const Fitting kSouth[] = {{kBare, kStore, 11},      {kPlainRoom, kOffice, 12}, {kPapered, kMeeting, 13},
                          {kPlastered, kLounge, 9}, {kPlainRoom, kStore, 15},  {kPapered, kOffice, 16}};
const Fitting kInnerNorth[] = {{kPlainRoom, kStudy, 21}, {kBare, kArchive, 22},      {kPapered, kKitchen, 23},
                               {kPlastered, kStudy, 24}, {kPlainRoom, kKitchen, 25}, {kPapered, kStudy, 26}};
const Fitting kInnerSouth[] = {{kPapered, kKitchen, 31}, {kPlainRoom, kArchive, 32},
                               {kPlastered, kStudy, 33}, {kPlainRoom, kArchive, 34},
                               {kBare, kStudy, 35},      {kPapered, kArchive, 36}};

GroundPlan around(double x_m, double y_m, double width_m, double depth_m) {
  return {x_m - width_m / 2.0, y_m - depth_m / 2.0, x_m + width_m / 2.0, y_m + depth_m / 2.0};
}

}  // namespace

std::vector<RoomPlan> buildingRooms() {
  std::vector<RoomPlan> plans = {{{-2.5, -5.5, 2.5, 5.5}, kPapered, kHall, 41},
                                 {{-30, 5.5, 30, 8}, kCorridor, kLongCorridor, 42},
                                 {{-30, -8, 30, -5.5}, kCorridor, kLongCorridor, 43, true},
                                 {{-30, -5.5, -27.5, 5.5}, kCorridor, kShortCorridor, 44},
                                 {{27.5, -5.5, 30, 5.5}, kCorridor, kShortCorridor, 45, true}};
  const auto add = [&](const Fitting& fitting, const GroundPlan& ground, bool turned) {
    plans.push_back({ground, fitting.finish, fitting.furniture, fitting.seed, turned});
  };
  for (int i = 0; i < 6; ++i) {
    const double inner_m = i == 1 || i == 4 ? 8.5 : 8.25;
    add(kNorth[i], around(kOuterDoor_m[i], 11.5, 10.0, 7.0), false);
    add(kSouth[i], around(kOuterDoor_m[i], -11.5, 10.0, 7.0), true);
    add(kInnerNorth[i], around(kInnerDoor_m[i], 2.75, inner_m, 5.5), true);
    add(kInnerSouth[i], around(kInnerDoor_m[i], -2.75, inner_m, 5.5), false);
  }
  const Vector2d moved_by_m = (buildingTwin(1).translation() - buildingTwin(0).translation()).head<2>();
  for (RoomPlan& plan : plans) {
    if (plan.ground.centre_m() == Vector2d(15.0, 11.5)) plan.look_moved_by_m = moved_by_m;
  }
  return plans;
}

std::vector<Doorway> buildingDoorways() {
  std::vector<Doorway> doors;
  for (const double y_m : {-5.5, 5.5}) {
    doors.push_back({0.0, y_m, 3.0, 2.3});
    for (const double x_m : {-28.75, 28.75}) doors.push_back({x_m, y_m, 2.1, 2.3});
    for (const double x_m : kInnerDoor_m) doors.push_back({x_m, y_m});
  }
  for (const double x_m : kOuterDoor_m) {
    doors.push_back({x_m, -8.0});
    doors.push_back({x_m, 8.0});
  }
  return doors;
}

Pose buildingTwin(int index) {
  Pose T_W_room = Pose::Identity();
  T_W_room.translation() << (index == 0 ? kOuterDoor_m[1] : kOuterDoor_m[4]), 11.5, 0.0;
  return T_W_room;
}

}  // namespace depth_fusion
