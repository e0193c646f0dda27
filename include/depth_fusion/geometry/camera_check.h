// What no pinhole camera can be.
#pragma once

#include <string>

#include "depth_fusion/geometry/camera_intrinsics.h"

namespace depth_fusion {

// Says why no camera can have these intrinsics: numbers that are not finite, focal lengths that are none
// (zeros, ones, a field of view beyond 150 degrees), a principal point outside of the image. Empty if one
// can. fy may be negative: y is up then (see frames/y_down.h).
std::string cameraProblem(const CameraIntrinsics& camera);

}  // namespace depth_fusion
