// How depth is preprocessed. The rows of table() say what each member means, in which unit and range.
#pragma once

#include <string>

#include "depth_fusion/common/parameters.h"
#include "depth_fusion/frames/depth_sensor.h"

namespace depth_fusion {

struct PreprocessingParameters {
  float min_range_m = 0.3f;
  float max_range_m = 5.0f;
  std::string depth_offsets_per_m;  // parseDepthOffsets() reads it
  float readout_s = 0.0f;
  float stamp_delay_s = 0.0f;
  float bilateral_sigma_px = 1.5f;
  float bilateral_cutoff_sigmas = 3.0f;
  float max_relative_step = 0.05f;

  ParameterTable table();
};

// Throws Error if a parameter lies outside its range, or if no depth lies in the range of both.
void validateRange(const PreprocessingParameters& parameters, const DepthSensorParameters& sensor);

// Nearer and farther depth is left out by every stage.
struct DepthRange {
  float min_m;
  float max_m;
};

// The range that is asked for, as far as the sensor's noise allows.
DepthRange depthRange(const PreprocessingParameters& parameters, const DepthSensorParameters& sensor);

}  // namespace depth_fusion
