#include "depth_fusion/preprocessing/preprocessing_parameters.h"

#include <algorithm>

#include "depth_fusion/common/error.h"
#include "depth_fusion/preprocessing/depth_correction.h"

namespace depth_fusion {

ParameterTable PreprocessingParameters::table() {
  return {
      number("min_range_m", &min_range_m, 0.0, 100.0, "nearer depth is left out"),
      number("max_range_m", &max_range_m, 0.01, 100.0, "farther depth is left out"),
      text("depth_offsets_per_m", &depth_offsets_per_m,
           "columns, rows and, row by row over the image, what to add to the inverse depth (1/m), as "
           "calibrate writes it; empty: nothing"),
      number("readout_s", &readout_s, 0.0, 1.0,
             "time from the first row's exposure to the last's (rolling shutter); 0: all at once (global "
             "shutter)"),
      number("stamp_delay_s", &stamp_delay_s, -1.0, 1.0, "time from the last row's exposure to the stamp"),
      number("bilateral_sigma_px", &bilateral_sigma_px, 0.1, 10.0,
             "width of the bilateral filter in the image"),
      number("bilateral_cutoff_sigmas", &bilateral_cutoff_sigmas, 0.1, 100.0,
             "depth difference, in standard deviations of the sensor, at which a neighbour counts no more"),
      number("max_relative_step", &max_relative_step, 0.001, 1.0,
             "depth step between neighbours two pixels apart, as a fraction of the depth, across which no "
             "normal is computed")};
}

void validateRange(const PreprocessingParameters& parameters, const DepthSensorParameters& sensor) {
  validate(PreprocessingParameters(parameters).table());
  validate(DepthSensorParameters(sensor).table());
  parseDepthOffsets(parameters.depth_offsets_per_m);
  check(parameters.min_range_m < std::min(parameters.max_range_m, sensor.maxRange_m()),
        "preprocessing/min_range_m must be below preprocessing/max_range_m and the range of "
        "depth_sensor/max_sigma_m");
}

DepthRange depthRange(const PreprocessingParameters& parameters, const DepthSensorParameters& sensor) {
  return {parameters.min_range_m, std::min(parameters.max_range_m, sensor.maxRange_m())};
}

}  // namespace depth_fusion
