#include "depth_fusion/relocalisation/relocaliser.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace depth_fusion {
namespace {

// How far apart two cameras stand; below 1 they see much of the same.
double separation(const Pose& T_W_A, const Pose& T_W_B, const RelocalisationParameters& parameters) {
  const Pose T_A_B = T_W_A.inverse() * T_W_B;
  return std::max(T_A_B.translation().norm() / parameters.keyframe_distance_m,
                  rotationAngle(T_A_B) / parameters.keyframe_angle_rad);
}

size_t mostCrowded(const Keyframes& keyframes, const RelocalisationParameters& parameters) {
  size_t most_crowded = 0;
  double smallest = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < keyframes.size(); ++i) {
    for (size_t k = 0; k < i; ++k) {
      const double distance = separation(keyframes[i]->T_W_D, keyframes[k]->T_W_D, parameters);
      if (distance >= smallest) continue;
      smallest = distance;
      most_crowded = k;
    }
  }
  return most_crowded;
}

}  // namespace

Relocaliser::Relocaliser(const RelocalisationParameters& parameters) : parameters_(parameters) {
  validate(parameters_.table());
}

void Relocaliser::setParameters(const RelocalisationParameters& parameters) {
  validate(RelocalisationParameters(parameters).table());
  parameters_ = parameters;
  dropSurplus();
}

void Relocaliser::add(double stamp_s, const FrameFeatures& features, const Pose& T_W_D,
                      const RgbdFrame* pictured) {
  if (!features.reason.empty() || parameters_.max_keyframes == 0) return;
  for (const KeyframePtr& keyframe : keyframes_) {
    if (separation(keyframe->T_W_D, T_W_D, parameters_) < 1.0) return;
  }
  const auto keyframe = std::make_shared<Keyframe>(keyframeOf(features, T_W_D, stamp_s));
  if (pictured != nullptr) keyframe->color = colorOf(*pictured);
  keyframes_.push_back(keyframe);
  dropSurplus();
}

void Relocaliser::reset(Keyframes keyframes) { keyframes_ = std::move(keyframes); }

void Relocaliser::dropSurplus() {
  while (static_cast<int>(keyframes_.size()) > parameters_.max_keyframes) {
    keyframes_.erase(keyframes_.begin() + mostCrowded(keyframes_, parameters_));
  }
}

Keyframes Relocaliser::candidates(const FrameFeatures& features) const {
  if (!features.reason.empty()) return {};
  const cv::Mat thumbnail = thumbnailOf(features);
  std::vector<std::pair<double, KeyframePtr>> ranked;
  for (const KeyframePtr& keyframe : keyframes_)
    ranked.emplace_back(-thumbnail.dot(keyframe->thumbnail), keyframe);
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  Keyframes best;
  for (const auto& [unlikeness, keyframe] : ranked) best.push_back(keyframe);
  best.resize(std::min(best.size(), static_cast<size_t>(parameters_.max_candidates)));
  return best;
}

}  // namespace depth_fusion
