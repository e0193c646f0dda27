// What a URDF says of a robot's shape.
#pragma once

#include <string>
#include <vector>

#include "depth_fusion/masking/solid_body.h"

namespace depth_fusion {

// The collision geometry of all links, or the visual one of a link that has no other. Of a mesh, its box
// along its own axes. Throws Error for a text that is no URDF, and for a mesh that cannot be read.
std::vector<BodyPart> partsOfRobot(const std::string& urdf);

}  // namespace depth_fusion
