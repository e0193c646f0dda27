#include "texturing/view_labelling.h"

#include <algorithm>
#include <limits>

namespace depth_fusion {
namespace {

constexpr int kSweeps = 12;  // there and back

using Costs = std::array<float, kMostViewsOfFace>;

class BeliefPropagation {
 public:
  BeliefPropagation(const std::vector<FaceViews>& faces, const FaceNeighbours& neighbours, float smoothness)
      : faces_(faces), neighbours_(neighbours), smoothness_(smoothness), messages_(faces.size()) {}

  std::vector<uint16_t> run() {
    const auto count = static_cast<uint32_t>(faces_.size());
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      for (uint32_t face = 0; face < count; ++face) send(face);
      for (uint32_t face = count; face-- > 0;) send(face);
    }
    std::vector<uint16_t> labels(count, kNoView);
    for (uint32_t face = 0; face < count; ++face) {
      const Costs beliefs = beliefsOf(face);
      const int views = countOf(faces_[face]);
      if (views > 0)
        labels[face] =
            faces_[face][std::min_element(beliefs.begin(), beliefs.begin() + views) - beliefs.begin()].view;
    }
    return labels;
  }

 private:
  // What a picture costs by the face itself and by all that its neighbours say.
  Costs beliefsOf(uint32_t face) const {
    Costs beliefs{};
    const FaceViews& views = faces_[face];
    for (int i = 0; i < countOf(views); ++i) {
      beliefs[i] = 1.0f - views[i].quality / views[0].quality;
      for (const Costs& message : messages_[face]) beliefs[i] += message[i];
    }
    return beliefs;
  }

  // Tells each neighbour what its pictures cost this face.
  void send(uint32_t face) {
    const int views = countOf(faces_[face]);
    if (views == 0) return;
    const Costs beliefs = beliefsOf(face);
    for (int side = 0; side < 3; ++side) {
      const uint32_t neighbour = neighbours_[face][side];
      if (neighbour == kNoFace) continue;
      const Costs& heard = messages_[face][side];
      float least = std::numeric_limits<float>::max();
      for (int i = 0; i < views; ++i) least = std::min(least, beliefs[i] - heard[i]);
      Costs& message = messages_[neighbour][sideOf(neighbour, face)];
      for (int i = 0; i < countOf(faces_[neighbour]); ++i) {
        const int place = placeOf(faces_[face], faces_[neighbour][i].view);
        message[i] = place < 0 ? smoothness_ : std::min(beliefs[place] - heard[place] - least, smoothness_);
      }
    }
  }

  int sideOf(uint32_t face, uint32_t neighbour) const {
    const auto& sides = neighbours_[face];
    return sides[0] == neighbour ? 0 : sides[1] == neighbour ? 1 : 2;
  }

  const std::vector<FaceViews>& faces_;
  const FaceNeighbours& neighbours_;
  const float smoothness_;
  std::vector<std::array<Costs, 3>> messages_;  // that a face has heard from beyond each of its edges
};

}  // namespace

std::vector<uint16_t> labelFaces(const std::vector<FaceViews>& faces, const FaceNeighbours& neighbours,
                                 float smoothness) {
  return BeliefPropagation(faces, neighbours, smoothness).run();
}

}  // namespace depth_fusion
