// The noise that a depth image has, against what the sensor model says.
#pragma once

#include <optional>
#include <string>

#include "depth_fusion/frames/rgbd_frame.h"
#include "depth_fusion/preprocessing/preprocessing_parameters.h"

namespace depth_fusion {

// Measures the axial noise by the second differences of neighbouring pixels, which surfaces hardly have
// (J. Immerkaer, "Fast Noise Variance Estimation", CVIU 1996, with medians in place of means, for edges).
// Returns the model, with sigma_base_m and sigma_growth_per_m raised to what fits the image, if that has over
// twice the model's noise anywhere in the range; else the model itself. Returns nothing if
// too little depth is there to say.
std::optional<DepthSensorParameters> raisedToNoise(const RgbdFrame& frame, const DepthRange& range,
                                                   const DepthSensorParameters& model);

// What to tell the user of a sensor that is used in the model's place; empty if it is the model's.
std::string noiseRemark(const DepthSensorParameters& model, const DepthSensorParameters& used);

}  // namespace depth_fusion
