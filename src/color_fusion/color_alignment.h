// Where the colour camera stands, by the colours of the map: clocks and calibrations of depth and colour
// differ by more than a pixel.
#pragma once

#include "color_fusion/surface_color.h"

namespace depth_fusion {

// The pose near T_C_W at which the image, times the gains of its channels, shows the surface as the map does:
// Gauss-Newton over the image's pyramid from a start on, which is T_C_W if not given, with T_C_W as the
// prior. The start itself where the colours do not say better.
Pose alignColor(const std::vector<SurfaceColor>& surface, const ColorImage& image, const Eigen::Array3d& gain,
                const Pose& T_C_W);
Pose alignColor(const std::vector<SurfaceColor>& surface, const ColorImage& image, const Eigen::Array3d& gain,
                const Pose& T_C_W, const Pose& start_T_C_W);

}  // namespace depth_fusion
