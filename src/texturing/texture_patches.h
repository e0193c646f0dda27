// Parts of the surface that have one picture each, and where they lie in the texture.
#pragma once

#include <vector>

#include "texturing/face_neighbours.h"
#include "texturing/face_views.h"
#include "texturing/rectangle_packing.h"

namespace depth_fusion {

// Faces that hang together and have the same picture; or, with kNoView, faces that no picture shows.
struct TexturePatch {
  uint16_t view = kNoView;
  std::vector<uint32_t> faces;
  std::vector<std::array<cv::Point2f, 3>> corners;  // of each face, pixels of the patch
  cv::Size size;
  PagePlace place;
};

struct TextureLayout {
  std::vector<TexturePatch> patches;
  std::vector<cv::Size> pages;
};

// A patch is as large as its part of the picture, so that no detail is lost. A face that no picture shows has
// 2x2 pixels: its vertices' colours are the middles of three of them.
TextureLayout layOut(const TriangleMesh& mesh, const std::vector<ChosenView>& views,
                     const std::vector<uint16_t>& labels, const FaceNeighbours& neighbours, int page_px);

}  // namespace depth_fusion
