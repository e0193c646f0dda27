// The texture's pixels.
#pragma once

#include <functional>
#include <vector>

#include "texturing/texture_patches.h"
#include "texturing/vertex_views.h"

namespace depth_fusion {

struct PaintedTexture {
  std::vector<cv::Mat> pages;  // CV_8UC3, BGR
  double fill = 0.0;           // see TexturingReport
};

PaintedTexture paint(const TriangleMesh& mesh, const std::vector<ChosenView>& views,
                     const std::vector<uint16_t>& labels, const VertexViews& vertices,
                     const TextureLayout& layout, const std::function<void(double)>& progress);

}  // namespace depth_fusion
