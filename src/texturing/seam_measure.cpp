#include "texturing/seam_measure.h"

#include <algorithm>
#include <cmath>

namespace depth_fusion {
namespace {

struct FacePlace {
  size_t page = 0;
  std::array<cv::Point2f, 3> corners;
};

std::vector<FacePlace> placesOf(const TextureLayout& layout, size_t faces) {
  std::vector<FacePlace> places(faces);
  for (const TexturePatch& patch : layout.patches) {
    for (size_t i = 0; i < patch.faces.size(); ++i) {
      FacePlace& place = places[patch.faces[i]];
      place.page = patch.place.page;
      for (int k = 0; k < 3; ++k) place.corners[k] = patch.corners[i][k] + cv::Point2f(patch.place.corner);
    }
  }
  return places;
}

// The colours in a patch at 0.5 and 1.5 pixels from the middle of an edge.
struct EdgeColors {
  Eigen::Array3f near, far;
};

EdgeColors colorsBeside(const FacePlace& face, int side, const std::vector<cv::Mat>& pages) {
  const cv::Point2f middle = 0.5f * (face.corners[side] + face.corners[(side + 1) % 3]);
  const cv::Point2f inward = face.corners[(side + 2) % 3] - middle;
  const cv::Point2f step = inward / std::max(std::hypot(inward.x, inward.y), 1e-6f);
  const cv::Point2f near = middle + 0.5f * step, far = middle + 1.5f * step;
  return {sampled(pages[face.page], near.x, near.y), sampled(pages[face.page], far.x, far.y)};
}

int sideOf(const FaceNeighbours& neighbours, uint32_t face, uint32_t neighbour) {
  const auto& sides = neighbours[face];
  return sides[0] == neighbour ? 0 : sides[1] == neighbour ? 1 : 2;
}

double difference(const Eigen::Array3f& a, const Eigen::Array3f& b) {
  return static_cast<double>((a - b).abs().mean());
}

}  // namespace

SeamMeasure measureSeams(const TriangleMesh& mesh, const FaceNeighbours& neighbours,
                         const std::vector<uint16_t>& labels, const TextureLayout& layout,
                         const std::vector<cv::Mat>& pages) {
  const std::vector<FacePlace> places = placesOf(layout, mesh.triangles.size());
  SeamMeasure result;
  size_t count = 0;
  for (uint32_t face = 0; face < labels.size(); ++face) {
    for (int side = 0; side < 3; ++side) {
      const uint32_t other = neighbours[face][side];
      if (other == kNoFace || other < face || labels[face] == labels[other] || labels[face] == kNoView ||
          labels[other] == kNoView)
        continue;
      const EdgeColors here = colorsBeside(places[face], side, pages);
      const EdgeColors there = colorsBeside(places[other], sideOf(neighbours, other, face), pages);
      result.step += difference(here.near, there.near);
      result.gradient += 0.5 * (difference(here.near, here.far) + difference(there.near, there.far));
      ++count;
    }
  }
  if (count > 0) {
    result.step /= static_cast<double>(count);
    result.gradient /= static_cast<double>(count);
  }
  return result;
}

}  // namespace depth_fusion
