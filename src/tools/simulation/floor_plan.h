// Buildings as data: rooms side by side, doors between them, and what stands in the rooms.
#pragma once

#include <string>
#include <vector>

#include "tools/simulation/furniture.h"
#include "tools/simulation/scene.h"

namespace depth_fusion {

// The ground that a room covers; the walls' middles lie on its edges, which are multiples of 1/4 m.
struct GroundPlan {
  double x0_m, y0_m, x1_m, y1_m;

  Eigen::Vector2d centre_m() const { return {(x0_m + x1_m) / 2.0, (y0_m + y1_m) / 2.0}; }
};

struct Finish {
  Material wall, floor, ceiling;
};

// Furniture is placed from the room's middle; `seed` moves it a little and tints it. Rooms of one size,
// finish, furniture and seed, with doorways at the same places, have the same shape, and the same colours
// where look_moved_by_m is the way from one to the other.
struct RoomPlan {
  GroundPlan ground;
  Finish finish;
  std::vector<Piece> furniture;
  int seed = 0;
  bool turned = false;  // the furniture, by half a turn
  Eigen::Vector2d look_moved_by_m = Eigen::Vector2d::Zero();
};

// An opening in every wall that its middle lies on.
struct Doorway {
  double x_m, y_m;
  double width_m = 1.1, height_m = 2.1;
};

constexpr double kRoomHeight_m = 2.6;

std::vector<Primitive> build(const std::vector<RoomPlan>& rooms, const std::vector<Doorway>& doorways);

}  // namespace depth_fusion
