// A floor of 60 x 30 m: a ring of corridors with a hall across its middle, where the origin is, and rooms
// on both sides of the corridors. Two of them, 30 m apart, are exactly alike.
#pragma once

#include "tools/simulation/floor_plan.h"

namespace depth_fusion {

// Where the doors of the rooms inside and outside of the ring are along the corridors in the north and south.
inline constexpr double kInnerDoor_m[] = {-23.375, -15.0, -6.625, 6.625, 15.0, 23.375};
inline constexpr double kOuterDoor_m[] = {-25.0, -15.0, -5.0, 5.0, 15.0, 25.0};

std::vector<RoomPlan> buildingRooms();
std::vector<Doorway> buildingDoorways();

// Where the middle of the floor of the first or second of the two rooms that are alike is.
Pose buildingTwin(int index);

}  // namespace depth_fusion
