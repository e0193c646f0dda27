// The pictures that keyframes have of a map.
#pragma once

#include <vector>

#include "depth_fusion/relocalisation/keyframe.h"
#include "depth_fusion/texturing/texturing.h"

namespace depth_fusion {

// The picture, taken when the depth camera was there.
TexturingView viewOf(const KeyframeColor& color, const Pose& T_W_D);

// The views of those keyframes that have a picture.
std::vector<TexturingView> viewsOf(const Keyframes& keyframes);

}  // namespace depth_fusion
