// How far a depth sensor's measurements are off. The same model weighs the pixels of the bilateral filter, of
// ICP and of fusion, and limits the range.
#pragma once

#include "depth_fusion/common/parameters.h"

namespace depth_fusion {

// The default is the Kinect v1 (Nguyen et al. 2012). The axial sigma, which is measured along the ray, is
// base + growth (z - from)^2. The rows of table() say what each member means, in which unit and range.
struct DepthSensorParameters {
  float sigma_base_m = 0.0012f;
  float sigma_growth_per_m = 0.0019f;
  float sigma_from_m = 0.4f;
  float lateral_sigma_px = 0.8f;
  float edge_sigmas = 2.0f;
  float max_sigma_m = 0.05f;

  ParameterTable table();

  // The depth from which on sigma is above max_sigma_m.
  float maxRange_m() const;
};

}  // namespace depth_fusion
