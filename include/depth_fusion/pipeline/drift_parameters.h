// How far tracking is off, beside what the sensor's noise does. The rows of table() say what each member
// means, in which unit and range.
#pragma once

#include "depth_fusion/common/parameters.h"

namespace depth_fusion {

// The default is a Kinect v1 that is not calibrated (docs/covariance.md).
struct DriftParameters {
  float frame_m = 0.002f;
  float frame_rad = 0.002f;
  float m_after_1m = 0.01f;
  float rad_after_1m = 0.005f;
  float m_after_1rad = 0.005f;
  float rad_after_1rad = 0.005f;
  float scale = 0.0f;

  ParameterTable table();
};

}  // namespace depth_fusion
