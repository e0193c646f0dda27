// What a lens does to a pinhole camera's image.
#pragma once

#include <string>
#include <vector>

#include "depth_fusion/geometry/camera_intrinsics.h"

namespace depth_fusion {

// k1 k2 p1 p2 [k3 [k4 k5 k6 [s1 s2 s3 s4 [tx ty]]]], OpenCV's order: plumb_bob and rational_polynomial in
// ROS. Empty: no distortion. The thin prism s and the tilt t are taken out of colour only.
using LensDistortion = std::vector<double>;

// Some coefficient is not zero.
bool distorts(const LensDistortion& lens);

// Throws Error if the coefficients are not as many as a known model has, or not finite.
void checkDistortion(const LensDistortion& lens);

// Throws Error, naming the camera, for a lens that is not taken out of depth: one with thin prism or tilt.
void checkDepthLens(const LensDistortion& lens, const std::string& name);

// The lens shows the rays up to this distance from the axis, squared, at depth 1; farther out its polynomial
// may turn back. Throws Error, naming the camera, if it does so before the image's nearest border: rays then
// cannot be told from pixels.
double maxSquaredRadius(const CameraIntrinsics& camera, const LensDistortion& lens, const std::string& name);

}  // namespace depth_fusion
