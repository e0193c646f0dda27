// Exposure and white balance: how a frame's colours compare with those of the map.
#pragma once

#include <optional>

#include "color_fusion/surface_color.h"

namespace depth_fusion {

// Factors from the image's blue, green and red to the map's: medians, so that half of the surface may look
// different. Dark and overexposed colours say nothing. Nothing if too few are left.
std::optional<Eigen::Array3d> exposureGain(const std::vector<SurfaceColor>& surface, const ColorImage& image,
                                           const Pose& T_C_W);

}  // namespace depth_fusion
