// What the pictures show of each face.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "texturing/view_image.h"

namespace depth_fusion {

constexpr int kMostViewsOfFace = 10;
constexpr uint16_t kNoView = 0xFFFF;

struct FaceView {
  uint16_t view = kNoView;
  std::array<uint8_t, 3> color{};  // mean about the face, blue green red, of the texture's brightness
  float quality = 0.0f;            // the face's pixels times the slope of the brightness about it
};

// The best pictures of a face, the best one first; the others are kNoView.
using FaceViews = std::array<FaceView, kMostViewsOfFace>;

int countOf(const FaceViews& views);
// Returns the place of the view, or -1.
int placeOf(const FaceViews& views, uint16_t view);

// The pictures that show all of a face: in the image, not hidden, not too aslant.
std::vector<FaceViews> viewsOfFaces(const TriangleMesh& mesh, const std::vector<ChosenView>& views,
                                    const TexturingParameters& parameters,
                                    const std::function<void(double)>& progress);

// Takes the pictures away whose colour is far from that of most pictures of the face: a person who went by,
// a reflection. Returns how many.
size_t removeOutliers(std::vector<FaceViews>& faces, double outlier_levels);

}  // namespace depth_fusion
