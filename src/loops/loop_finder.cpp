#include "depth_fusion/loops/loop_finder.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

// A word that more keyframes have says nothing; below so many keyframes every word counts.
constexpr double kCommonShare = 0.5;
constexpr size_t kFewKeyframes = 20;

constexpr int kDescriptorBits = 256;

// The bits that each table reads, no bit twice.
std::vector<uint8_t> drawnBits(size_t count) {
  std::vector<uint8_t> bits(kDescriptorBits);
  for (size_t i = 0; i < bits.size(); ++i) bits[i] = static_cast<uint8_t>(i);
  std::mt19937 random(7);
  for (size_t i = 0; i < count; ++i) std::swap(bits[i], bits[i + random() % (bits.size() - i)]);
  bits.resize(count);
  return bits;
}

}  // namespace

LoopFinder::LoopFinder(int max_features)
    : max_features_(max_features), keyframes_of_(size_t{kTables} << kWordBits) {
  check(max_features > 0, "an index of keyframes needs features");
}

LoopFinder::Words LoopFinder::wordsOf(const BriefDescriptor& descriptor) {
  static const std::vector<uint8_t> bits = drawnBits(kTables * kWordBits);
  Words words{};
  for (size_t i = 0; i < bits.size(); ++i) {
    const uint64_t bit = descriptor[bits[i] / 64] >> (bits[i] % 64) & 1u;
    words[i / kWordBits] = static_cast<uint16_t>(words[i / kWordBits] | bit << (i % kWordBits));
  }
  return words;
}

std::vector<size_t> LoopFinder::chosen(const FrameFeatures& features) const {
  const size_t all = features.features.size(), count = std::min(all, static_cast<size_t>(max_features_));
  std::vector<size_t> indices(count);
  for (size_t i = 0; i < count; ++i) indices[i] = i * all / count;
  return indices;
}

void LoopFinder::add(uint32_t number, const FrameFeatures& features) {
  check(number >= keyframes_, "keyframes are indexed in the order of their numbers");
  words_of_.resize(number + 1, 0.0f);
  for (const size_t index : chosen(features)) {
    const Words words = wordsOf(features.features[index].descriptor);
    for (size_t table = 0; table < kTables; ++table)
      keyframes_of_[(table << kWordBits) + words[table]].push_back(number);
    words_of_[number] += kTables;
  }
  keyframes_ = number + 1;
}

std::vector<AlikeKeyframe> LoopFinder::find(const FrameFeatures& features,
                                            const std::function<bool(uint32_t number)>& isEligible,
                                            size_t count) const {
  std::vector<float> likeness(keyframes_, 0.0f);
  const size_t common =
      std::max(kFewKeyframes, static_cast<size_t>(kCommonShare * static_cast<double>(keyframes_)));
  for (const size_t index : chosen(features)) {
    const Words words = wordsOf(features.features[index].descriptor);
    for (size_t table = 0; table < kTables; ++table) {
      const std::vector<uint32_t>& keyframes = keyframes_of_[(table << kWordBits) + words[table]];
      if (keyframes.empty() || keyframes.size() > common) continue;
      const auto rarity =
          std::log(1.0f + static_cast<float>(keyframes_) / static_cast<float>(keyframes.size()));
      for (const uint32_t keyframe : keyframes) likeness[keyframe] += rarity;
    }
  }
  std::vector<AlikeKeyframe> alike;
  for (uint32_t number = 0; number < keyframes_; ++number) {
    if (likeness[number] <= 0.0f || !isEligible(number)) continue;
    alike.push_back({number, likeness[number] / std::sqrt(words_of_[number])});
  }
  const size_t kept = std::min(count, alike.size());
  std::partial_sort(alike.begin(), alike.begin() + static_cast<std::ptrdiff_t>(kept), alike.end(),
                    [](const AlikeKeyframe& a, const AlikeKeyframe& b) {
                      return a.likeness != b.likeness ? a.likeness > b.likeness : a.number < b.number;
                    });
  alike.resize(kept);
  return alike;
}

size_t LoopFinder::bytes() const {
  size_t bytes = words_of_.capacity() * sizeof(float);
  for (const std::vector<uint32_t>& keyframes : keyframes_of_)
    bytes += sizeof(keyframes) + keyframes.capacity() * sizeof(uint32_t);
  return bytes;
}

}  // namespace depth_fusion
