// The scenes of the library, one function each.
#pragma once

#include "tools/simulation/scene_library.h"

namespace depth_fusion {

SimulatedScene makeRoomScene();
SimulatedScene makeWhiteRoomScene();
SimulatedScene makeObjectScene();
SimulatedScene makeSealScene();
SimulatedScene makeWallScene();
SimulatedScene makeFloorWallScene();
SimulatedScene makeCylinderScene();

}  // namespace depth_fusion
