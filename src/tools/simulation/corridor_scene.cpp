// A corridor of 100 m along x, 2.5 m wide, with a lobby at each end; the origin is the middle of the first
// lobby.
#include "tools/simulation/floor_plan.h"
#include "tools/simulation/scenes.h"

namespace depth_fusion {
namespace {

using Furniture = std::vector<Piece>;

const Material kPaint{{185, 200, 205}, Pattern::kSpeckles, 0.25, 0.2};
const Material kTiling{{140, 145, 145}, Pattern::kTiles, 0.3, 0.3};
const Material kCeiling{{215, 218, 220}, Pattern::kPlain};
const Finish kFinish{kPaint, kTiling, kCeiling};

// From the middle, which is 50 m from both ends.
const Furniture kCorridorFurniture = {
    {"door", -44.6, 1.15, -90, 0, 14, 6.9},    {"door", -42.1, -1.15, 90, 0, 12, 7.7},
    {"picture", -42.4, 1.15, -90, 0, 7, 13.8}, {"notice", -35.3, 1.15, -90, 0, 6, 13.8},
    {"bench", -38.2, -1.15, 90, 0, 6, 15.4},   {"radiator", -30.3, -1.15, 90, 0, 5, 15.4},
    {"pillar", -40.9, 1.15, -90, 0, 6, 16.1},  {"pillar", -39.9, -1.15, 90, 0, 9, 9.9},
    {"plant", -33.2, 1.15, -90, 0, 5, 17.3},   {"cabinet", -25.4, 1.15, -90, 0, 3, 27.1},
    {"bin", -46.3, -1.15, 90, 0, 5, 20.6},     {"hydrant", -36.2, -1.15, 90, 0, 3, 30.9},
    {"lamp", -45.6, 0, 90, 0, 29, 3.3},        {"beam", -43.7, 0, 0, 0, 15, 6.3},
    {"sign", -31.7, 0, 0, 0, 4, 21.4}};
const Furniture kLobbyFurniture = {{"bench", -2.9, 1.4, 0},         {"plant", -2.9, -1.6, 0},
                                   {"cabinet", 0.6, -2.9, 90},      {"board", 0, 2.9, -90},
                                   {"picture", -2.9, 0, 0},         {"locker", -1.6, -2.9, 90},
                                   {"beam", -1.4, 0, 0, 0, 2, 2.8}, {"lamp", 0, -1.4, 90, 0, 2, 0, 2.8}};

Walk thereAndBack() {
  return walkAlong("there_and_back", "210 m in 352 s: along the corridor, round in the lobby, and back",
                   {{0, -0.25},
                    {101.8, -0.25},
                    {101.8, 1.75},
                    {99.4, 1.75},
                    {99.4, 0.25},
                    {0.6, 0.25},
                    {0.6, 1.75},
                    {-1.8, 1.75},
                    {-1.8, -0.25}});
}

Walk driveThrough() {
  return driveAlong(
      "drive", "a robot: 60 m along the corridor from the first lobby, round, and back",
      {{0, -0.25}, {60, -0.25}, {60, 0.25}, {0.6, 0.25}, {0.6, 1.75}, {-1.8, 1.75}, {-1.8, -0.25}});
}

std::vector<Primitive> corridor() {
  return build({{{3, -1.25, 97, 1.25}, kFinish, kCorridorFurniture, 1},
                {{-3, -3, 3, 3}, kFinish, kLobbyFurniture, 2},
                {{97, -3, 103, 3}, kFinish, kLobbyFurniture, 3, true}},
               {{3, 0, 2.1, 2.3}, {97, 0, 2.1, 2.3}});
}

}  // namespace

SimulatedScene makeCorridorScene() { return sceneWithWalks(corridor(), {thereAndBack(), driveThrough()}); }

SimulatedScene makeWhiteCorridorScene() {
  Material white{{225, 225, 225}, Pattern::kPlain};
  white.shaded = false;
  std::vector<Primitive> solids = corridor();
  for (Primitive& solid : solids) solid.paint(white);
  return sceneWithWalks(std::move(solids), {thereAndBack(), driveThrough()});
}

}  // namespace depth_fusion
