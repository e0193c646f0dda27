// The pictures that meet at each vertex: how much of each, and what levels them.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "texturing/face_views.h"

namespace depth_fusion {

// A face of whatever picture takes its colour at a vertex from all that meet there, by their weights, so that
// it is the same on both sides of a seam.
struct VertexView {
  uint16_t view = kNoView;
  float weight = 0.0f;  // all weights at a vertex sum up to 1, or are 0: there, each face has its own picture
  Eigen::Array3f leveling = Eigen::Array3f::Zero();  // added to the picture's colours, blue green red
};

class VertexViews {
 public:
  // A picture weighs as many of the faces about a vertex as have it, if it shows all of these faces.
  VertexViews(const TriangleMesh& mesh, const std::vector<FaceViews>& faces,
              const std::vector<uint16_t>& labels);

  const VertexView* begin(uint32_t vertex) const { return entries_.data() + begins_[vertex]; }
  const VertexView* end(uint32_t vertex) const { return entries_.data() + begins_[vertex + 1]; }
  // Null if the view does not meet there.
  const VertexView* find(uint32_t vertex, uint16_t view) const;
  // The share of the view in the colour at a corner of a face whose own is `label`.
  float weightOf(uint32_t vertex, uint16_t view, uint16_t label) const;

  std::vector<VertexView>& entries() { return entries_; }
  size_t numberOf(const VertexView* entry) const { return static_cast<size_t>(entry - entries_.data()); }

 private:
  bool isBlended(uint32_t vertex) const;

  std::vector<size_t> begins_;  // of each vertex in the entries, and their end
  std::vector<VertexView> entries_;
};

// Finds the levelling: colours that are added to each picture's part of the surface, as smooth as
// `seam_stiffness` says, so that parts that meet have the same colours where they do.
void levelSeams(const TriangleMesh& mesh, const std::vector<ChosenView>& views,
                const std::vector<uint16_t>& labels, float seam_stiffness, VertexViews& vertices);

}  // namespace depth_fusion
