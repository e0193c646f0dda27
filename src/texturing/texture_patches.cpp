#include "texturing/texture_patches.h"

#include <algorithm>
#include <cmath>

namespace depth_fusion {
namespace {

constexpr int kPatchMargin_px = 3;   // about a patch: neighbours in the texture do not shine in
constexpr size_t kFacesAcross = 32;  // of a patch that no picture shows
constexpr int kFacePixels = 2;

// Faces of one label that hang together.
std::vector<TexturePatch> connected(const std::vector<uint16_t>& labels, const FaceNeighbours& neighbours) {
  std::vector<TexturePatch> patches;
  std::vector<bool> is_taken(labels.size(), false);
  for (uint32_t first = 0; first < labels.size(); ++first) {
    if (is_taken[first] || labels[first] == kNoView) continue;
    TexturePatch patch{labels[first], {first}, {}, {}, {}};
    is_taken[first] = true;
    for (size_t i = 0; i < patch.faces.size(); ++i) {
      for (const uint32_t next : neighbours[patch.faces[i]]) {
        if (next == kNoFace || is_taken[next] || labels[next] != patch.view) continue;
        is_taken[next] = true;
        patch.faces.push_back(next);
      }
    }
    patches.push_back(std::move(patch));
  }
  return patches;
}

// Its corner lies at a whole pixel of the picture, so that pixels of the texture are pixels of the picture.
void measure(const TriangleMesh& mesh, const TexturingView& view, TexturePatch& patch) {
  const Eigen::Isometry3f T_C_W = view.T_W_C.inverse().cast<float>();
  Eigen::Array2f least = Eigen::Array2f::Constant(1e9f), most = -least;
  for (const uint32_t face : patch.faces) {
    std::array<cv::Point2f, 3> corners;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3f uvz =
          projected(T_C_W * mesh.vertices[mesh.triangles[face][i]].position_W, view.camera);
      corners[i] = {uvz.x(), uvz.y()};
      least = least.min(uvz.head<2>().array());
      most = most.max(uvz.head<2>().array());
    }
    patch.corners.push_back(corners);
  }
  const cv::Point2f origin(std::floor(least.x()) - kPatchMargin_px, std::floor(least.y()) - kPatchMargin_px);
  for (auto& corners : patch.corners) {
    for (cv::Point2f& corner : corners) corner -= origin;
  }
  patch.size = {static_cast<int>(std::ceil(most.x() - origin.x)) + kPatchMargin_px + 1,
                static_cast<int>(std::ceil(most.y() - origin.y)) + kPatchMargin_px + 1};
}

std::vector<TexturePatch> unseen(const std::vector<uint16_t>& labels) {
  std::vector<TexturePatch> patches;
  for (uint32_t face = 0; face < labels.size(); ++face) {
    if (labels[face] != kNoView) continue;
    if (patches.empty() || patches.back().faces.size() == kFacesAcross * kFacesAcross) patches.emplace_back();
    TexturePatch& patch = patches.back();
    const auto x = static_cast<float>(kFacePixels * static_cast<int>(patch.faces.size() % kFacesAcross));
    const auto y = static_cast<float>(kFacePixels * static_cast<int>(patch.faces.size() / kFacesAcross));
    patch.faces.push_back(face);
    patch.corners.push_back({cv::Point2f(x, y), cv::Point2f(x + 1.0f, y), cv::Point2f(x, y + 1.0f)});
    patch.size = {kFacePixels * static_cast<int>(std::min(patch.faces.size(), kFacesAcross)),
                  static_cast<int>(y) + kFacePixels};
  }
  return patches;
}

}  // namespace

TextureLayout layOut(const TriangleMesh& mesh, const std::vector<ChosenView>& views,
                     const std::vector<uint16_t>& labels, const FaceNeighbours& neighbours, int page_px) {
  TextureLayout layout;
  layout.patches = connected(labels, neighbours);
  cv::parallel_for_({0, static_cast<int>(layout.patches.size())}, [&](const cv::Range& range) {
    for (int i = range.start; i < range.end; ++i)
      measure(mesh, views[layout.patches[i].view].view, layout.patches[i]);
  });
  for (TexturePatch& patch : unseen(labels)) layout.patches.push_back(std::move(patch));
  std::vector<cv::Size> sizes;
  for (const TexturePatch& patch : layout.patches) sizes.push_back(patch.size);
  const RectanglePacking packing = packed(sizes, page_px);
  for (size_t i = 0; i < sizes.size(); ++i) layout.patches[i].place = packing.places[i];
  layout.pages = packing.pages;
  return layout;
}

}  // namespace depth_fusion
