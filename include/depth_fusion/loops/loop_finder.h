// Keyframes that look alike, among thousands: an index over the bits of their features' descriptors.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "depth_fusion/frames/frame_features.h"

namespace depth_fusion {

struct AlikeKeyframe {
  uint32_t number = 0;
  double likeness = 0.0;  // of the words that both have, by how rare they are
};

// Locality-sensitive hashing (Gionis, Indyk and Motwani 1999): each of several tables reads a word of some
// bits of a descriptor; descriptors that differ in few bits have some of the words in common. Words count by
// how rare they are (Sivic and Zisserman 2003).
class LoopFinder {
 public:
  // Of each keyframe, so many features are indexed at most.
  explicit LoopFinder(int max_features);

  // Numbers come in ascending order, from 0 on.
  void add(uint32_t number, const FrameFeatures& features);
  // The keyframes that look most alike, best first, so many at most; `isEligible` says which of them count.
  std::vector<AlikeKeyframe> find(const FrameFeatures& features,
                                  const std::function<bool(uint32_t number)>& isEligible, size_t count) const;

  size_t bytes() const;

 private:
  static constexpr int kTables = 6;
  static constexpr int kWordBits = 16;
  using Words = std::array<uint16_t, kTables>;

  static Words wordsOf(const BriefDescriptor& descriptor);
  // The indices of the features that are indexed, spread evenly.
  std::vector<size_t> chosen(const FrameFeatures& features) const;

  int max_features_;
  uint32_t keyframes_ = 0;
  std::vector<float> words_of_;                      // how many words a keyframe has
  std::vector<std::vector<uint32_t>> keyframes_of_;  // of each table's words
};

}  // namespace depth_fusion
