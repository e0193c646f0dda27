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
SimulatedScene makeBuildingScene();
SimulatedScene makeCorridorScene();
SimulatedScene makeWhiteCorridorScene();
SimulatedScene makeRepeatedCorridorScene();
SimulatedScene makeAlikeScene();
SimulatedScene makeLargeRoomScene();
SimulatedScene makePersonScene();
SimulatedScene makeHandScene();
SimulatedScene makeTurntableScene();
SimulatedScene makeMirrorScene();
SimulatedScene makeGlassScene();
SimulatedScene makeBackingScene();
SimulatedScene makeShakenScene();

// A scene seen by a Kinect-like sensor.
SimulatedScene sceneWithWalks(std::vector<Primitive> solids, const std::vector<Walk>& walks);

}  // namespace depth_fusion
