// How visible the seams of a texture are.
#pragma once

#include <vector>

#include "texturing/texture_patches.h"

namespace depth_fusion {

struct SeamMeasure {
  double step = 0.0;      // mean difference of colour across the borders of patches, 0 to 255
  double gradient = 0.0;  // the same over the same distance within the patches, beside the borders
};

// Compares two pixels of the texture on both sides of each border, and two on either side.
SeamMeasure measureSeams(const TriangleMesh& mesh, const FaceNeighbours& neighbours,
                         const std::vector<uint16_t>& labels, const TextureLayout& layout,
                         const std::vector<cv::Mat>& pages);

}  // namespace depth_fusion
