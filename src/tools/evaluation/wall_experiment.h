// The filters of fusion on a flat wall with noise of one's choice, through the whole pipeline: each column of
// voxels along the view is a filter's history of its own.
#pragma once

#include <functional>

#include "depth_fusion/compute/compute_context.h"
#include "depth_fusion/tsdf_fusion/tsdf_fusion.h"

namespace depth_fusion {

// Says what a frame shows. The sensor model says first_sigma_m; a filter that is told of the noise is given
// its growth beyond that as weights.
struct WallFrame {
  double z_m = 1.0;
  double sigma_m = 0.0;
};

struct WallExperiment {
  std::function<WallFrame(int)> frame_at;
  int frames = 200;
  int first_measured_frame = 0;  // errors are measured from here on
  int seed = 0;
  double first_sigma_m = 0.0019;
  bool told_of_noise = false;
  float voxel_size_m = 0.004f;
};

// The error of the columns' zero crossings. In each column the one nearest to the wall counts, stray surfaces
// do not.
struct WallError {
  double mean_m = 0.0;  // away from the sensor
  double rms_m = 0.0;
  size_t columns = 0;  // with a zero crossing
};

// Returns the error of the surface after each measured frame.
std::vector<WallError> runWallExperiment(ComputeContext& compute, const WallExperiment& experiment,
                                         const TsdfFusionParameters& fusion);

// Makes the paper's case of growing noise: the noise is that of the default sensor model at a distance that
// grows evenly from 1 to 2 m.
WallExperiment growingNoise();

// Returns the root of the mean square of the errors of the frames from `first` on.
double rootMeanSquare(const std::vector<WallError>& errors, size_t first);

// Returns the rule with the parameter that gives it the gain in the long run, at the sensor model's noise.
TsdfFusionParameters filterOfGain(const std::string& rule, double gain, double sigma_m);

}  // namespace depth_fusion
