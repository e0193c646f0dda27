// The rows of a map's keyframes.
#pragma once

#include <string>

#include "depth_fusion/relocalisation/keyframe.h"

namespace depth_fusion {

// A packed row.
std::string keyframeRow(const Keyframe& keyframe);
// Throws Error, naming `where`, for a damaged row.
Keyframe parseKeyframe(const std::string& row, const std::string& where);

}  // namespace depth_fusion
