// What a real depth sensor makes of an ideal view.
#pragma once

#include <cstdint>

#include "tools/simulation/color_model.h"

namespace depth_fusion {

struct SensorModel {
  CameraIntrinsics camera{640, 480, 525.0, 525.0, 319.5, 239.5};
  double depth_unit_m = 0.0002;  // of the 16-bit depth that recordings hold
  double min_range_m = 0.0;
  double max_range_m = 0.0;
  // The axial noise, that of quantisation included, has sigma = base + growth * (z - from)^2.
  double sigma_base_m = 0.0;
  double sigma_growth_per_m = 0.0;
  double sigma_from_m = 0.0;
  double noise_width_px = 0.0;  // of the Gaussian that the noise is smoothed with; 0: pixels are independent
  double disparity_pxm = 0.0;   // focal length times baseline; disparity = disparity_pxm / z
  double disparity_step_px = 0.0;  // disparities are multiples of it; 0: not quantised
  double lateral_sigma_px = 0.0;   // jitter of where a pixel looks
  double edge_step = 0.03;         // a step of this fraction of the depth between neighbours is an edge
  double edge_dropout = 0.0;       // probability that a pixel at a depth edge has no depth
  double grazing_cos = 0.0;        // rays flatter than this lose depth, the likelier the flatter
  double readout_s = 0.0;          // rolling shutter, of depth and colour: the last row is read at the stamp
  ColorModel color;

  double axialSigma(double z_m) const {
    return sigma_base_m + sigma_growth_per_m * (z_m - sigma_from_m) * (z_m - sigma_from_m);
  }
};

// Models structured light of the Kinect v1 kind, 0.4 to 5 m. Sigma and correlation are about those of real
// recordings (TUM freiburg1, 7-Scenes redkitchen), whose neighbours correlate by 0.55, 0.35, 0.2 and 0.1 at 1
// to 4 pixels.
SensorModel kinectSensor();
// Models a close-range precision scanner with a sigma of 0.1 mm at 0.3 m and a range of 0.15 to 1 m.
SensorModel precisionSensor();

// Models a scanner of small parts with a sigma of 0.05 to 0.07 mm at 0.2 to 0.5 m and 22 degrees of view.
SensorModel partScanner();

// Returns depth as the sensor gives it (CV_32FC1, metres, 0 = none). The same seed gives the same image, bit
// for bit.
cv::Mat senseDepth(const RenderedView& view, const SensorModel& sensor, uint64_t seed);

// Returns the view's depth within the sensor's range, without noise.
cv::Mat idealDepth(const RenderedView& view, const SensorModel& sensor);

}  // namespace depth_fusion
