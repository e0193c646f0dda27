#include "texture_odometry/brief.h"

#include <algorithm>
#include <cmath>

namespace depth_fusion {
namespace {

struct Comparison {
  cv::Point first, second;
};

int gaussianOffset(cv::RNG& random) {
  const int offset = static_cast<int>(std::lround(random.gaussian((2 * kBriefRadius_px + 1) / 5.0)));
  return std::clamp(offset, -kBriefRadius_px, kBriefRadius_px);
}

std::array<Comparison, 256> makePattern() {
  cv::RNG random(0x5eed);
  std::array<Comparison, 256> pattern;
  for (Comparison& comparison : pattern) {
    for (cv::Point* point : {&comparison.first, &comparison.second}) {
      point->x = gaussianOffset(random);
      point->y = gaussianOffset(random);
    }
  }
  return pattern;
}

uint64_t countBits(uint64_t bits) {
  bits -= (bits >> 1) & 0x5555555555555555u;
  bits = (bits & 0x3333333333333333u) + ((bits >> 2) & 0x3333333333333333u);
  bits = (bits + (bits >> 4)) & 0x0f0f0f0f0f0f0f0fu;
  return (bits * 0x0101010101010101u) >> 56;
}

}  // namespace

BriefDescriptor describe(const cv::Mat& smoothed, cv::Point pixel) {
  static const std::array<Comparison, 256> pattern = makePattern();
  const int step = static_cast<int>(smoothed.step);
  const uint8_t* centre = smoothed.ptr<uint8_t>(pixel.y) + pixel.x;
  BriefDescriptor descriptor{};
  for (size_t i = 0; i < pattern.size(); ++i) {
    const auto& [first, second] = pattern[i];
    const uint64_t darker = centre[first.y * step + first.x] < centre[second.y * step + second.x];
    descriptor[i / 64] |= darker << (i % 64);
  }
  return descriptor;
}

int hammingDistance(const BriefDescriptor& a, const BriefDescriptor& b) {
  uint64_t distance = 0;
  for (size_t i = 0; i < a.size(); ++i) distance += countBits(a[i] ^ b[i]);
  return static_cast<int>(distance);
}

}  // namespace depth_fusion
