#include "texturing/vertex_views.h"

#include <algorithm>

namespace depth_fusion {
namespace {

// The faces about each vertex, one vertex after the other.
struct FacesOfVertices {
  std::vector<size_t> begins;
  std::vector<uint32_t> faces;

  explicit FacesOfVertices(const TriangleMesh& mesh) : begins(mesh.vertices.size() + 1, 0) {
    for (const MeshTriangle& t : mesh.triangles) {
      for (const uint32_t vertex : t) ++begins[vertex + 1];
    }
    for (size_t i = 1; i < begins.size(); ++i) begins[i] += begins[i - 1];
    std::vector<size_t> next(begins.begin(), begins.end() - 1);
    faces.resize(3 * mesh.triangles.size());
    for (uint32_t face = 0; face < mesh.triangles.size(); ++face) {
      for (const uint32_t vertex : mesh.triangles[face]) faces[next[vertex]++] = face;
    }
  }
};

}  // namespace

VertexViews::VertexViews(const TriangleMesh& mesh, const std::vector<FaceViews>& faces,
                         const std::vector<uint16_t>& labels) {
  const FacesOfVertices about(mesh);
  for (size_t vertex = 0; vertex < mesh.vertices.size(); ++vertex) {
    const size_t first = entries_.size();
    begins_.push_back(first);
    for (size_t i = about.begins[vertex]; i < about.begins[vertex + 1]; ++i) {
      const uint16_t label = labels[about.faces[i]];
      const auto is_label = [&](const VertexView& entry) { return entry.view == label; };
      if (label != kNoView &&
          std::none_of(entries_.begin() + static_cast<std::ptrdiff_t>(first), entries_.end(), is_label))
        entries_.push_back({label});
    }
    float sum = 0.0f;
    for (size_t k = first; k < entries_.size(); ++k) {
      VertexView& entry = entries_[k];
      bool shows_all = true;
      for (size_t i = about.begins[vertex]; i < about.begins[vertex + 1]; ++i) {
        const uint32_t face = about.faces[i];
        if (labels[face] == entry.view) entry.weight += 1.0f;
        shows_all = shows_all && (labels[face] == kNoView || placeOf(faces[face], entry.view) >= 0);
      }
      if (!shows_all) entry.weight = 0.0f;
      sum += entry.weight;
    }
    for (size_t k = first; k < entries_.size() && sum > 0.0f; ++k) entries_[k].weight /= sum;
  }
  begins_.push_back(entries_.size());
}

const VertexView* VertexViews::find(uint32_t vertex, uint16_t view) const {
  const VertexView* found =
      std::find_if(begin(vertex), end(vertex), [&](const VertexView& entry) { return entry.view == view; });
  return found == end(vertex) ? nullptr : found;
}

bool VertexViews::isBlended(uint32_t vertex) const {
  return std::any_of(begin(vertex), end(vertex), [](const VertexView& entry) { return entry.weight > 0.0f; });
}

float VertexViews::weightOf(uint32_t vertex, uint16_t view, uint16_t label) const {
  if (!isBlended(vertex)) return view == label ? 1.0f : 0.0f;
  const VertexView* entry = find(vertex, view);
  return entry == nullptr ? 0.0f : entry->weight;
}

}  // namespace depth_fusion
