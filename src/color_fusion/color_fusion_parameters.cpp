#include "depth_fusion/color_fusion/color_fusion_parameters.h"

namespace depth_fusion {

ParameterTable ColorFusionParameters::table() {
  return {
      number("weight_at_1m", &weight_at_1m, 0.1, 255.0,
             "weight of a pixel seen head-on from 1 m; falls with the squares of depth and of the angle's "
             "cosine"),
      number("max_weight", &max_weight, 1.0, 255.0, "bound of a voxel's colour weight"),
      number(
          "max_relative_step", &max_relative_step, 0.001, 1.0,
          "depth step between neighbours, as a fraction of the depth, beside which colour has little weight"),
      number("hidden_sigmas", &hidden_sigmas, 0.0, 100.0,
             "standard deviations of the sensor, beside half the truncation, by which what is hidden lies "
             "behind"),
      flag("match_exposure", &match_exposure,
           "true: each frame's exposure and white balance follow the map's"),
      flag("align", &align, "true: the colour camera's pose is corrected until its colours fit the map's"),
      number("sample_stride_px", &sample_stride_px, 1, 64,
             "spacing of the grid of pixels that exposure and alignment look at"),
      number("blur_exponent", &blur_exponent, 0.0, 10.0,
             "an image's weight falls with this power of its sharpness, compared with the sharpest of late")};
}

}  // namespace depth_fusion
