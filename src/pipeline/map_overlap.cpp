#include "pipeline/map_overlap.h"

#include <cmath>
#include <string>
#include <utility>

#include "depth_fusion/common/error.h"
#include "depth_fusion/pipeline/map_refinement.h"

namespace depth_fusion {
namespace {

constexpr double kMostElsewhere = 0.34;  // of what fits, that may say something else

// How far the keyframe is apart by the two motions.
double apart_m(const Fit& fit, const Pose& T_A_B) {
  return ((fit.T_A_B * fit.T_B_D).translation() - (T_A_B * fit.T_B_D).translation()).norm();
}

bool agrees(const Fit& fit, const Pose& T_A_B, const LoopParameters& loops) {
  return apart_m(fit, T_A_B) <= static_cast<double>(loops.agreement_m) &&
         rotationAngle(fit.T_A_B.inverse() * T_A_B) <= static_cast<double>(loops.agreement_rad);
}

std::vector<Fit> agreeingWith(const Pose& T_A_B, const std::vector<Fit>& fits, const LoopParameters& loops) {
  std::vector<Fit> agreeing;
  for (const Fit& fit : fits) {
    if (agrees(fit, T_A_B, loops)) agreeing.push_back(fit);
  }
  return agreeing;
}

// The mean of the motions, about the middle of the keyframes.
Pose meanOf(const std::vector<Fit>& fits) {
  Pose mean = fits.front().T_A_B;
  constexpr int kIterations = 5;
  for (int i = 0; i < kIterations; ++i) {
    Vector6d twist = Vector6d::Zero();
    Eigen::Vector3d middle_B = Eigen::Vector3d::Zero();
    const double share = 1.0 / static_cast<double>(fits.size());
    for (const Fit& fit : fits) middle_B += share * fit.T_B_D.translation();
    const Pose about(Eigen::Translation3d(mean * middle_B));
    for (const Fit& fit : fits)
      twist += share * twistFromPose(about.inverse() * fit.T_A_B * mean.inverse() * about);
    mean = orthonormalized(about * poseFromTwist(twist) * about.inverse() * mean);
  }
  return mean;
}

}  // namespace

OverlapSearch::OverlapSearch(ComputeContext& compute, OpenMap& first)
    : compute_(compute),
      first_(first),
      loops_(first.parameters().loops),
      verifier_(loops_),
      finder_(loops_.index_features),
      seen_(first.loaded().keyframes.size()) {
  for (uint32_t number = 0; number < seen_.size(); ++number)
    finder_.add(number, first.loaded().keyframes[number]->features);
}

std::optional<Fit> OverlapSearch::fit(const Keyframe& keyframe) {
  const auto any = [](uint32_t) { return true; };
  for (const AlikeKeyframe& alike :
       finder_.find(keyframe.features, any, static_cast<size_t>(loops_.max_candidates))) {
    const Keyframe& old_keyframe = seen(alike.number);
    LoopCandidate loop;
    if (!verifier_.verify(old_keyframe, keyframe, loop)) continue;
    return Fit{keyframe.T_W_D,
               aligned(keyframe, old_keyframe.T_W_D * loop.T_old_new) * keyframe.T_W_D.inverse()};
  }
  return std::nullopt;
}

const Keyframe& OverlapSearch::seen(uint32_t number) {
  std::optional<Keyframe>& seen = seen_[number];
  if (!seen) seen = first_.seen(*first_.loaded().keyframes[number]);
  return *seen;
}

Pose OverlapSearch::aligned(const Keyframe& keyframe, const Pose& T_A_D) {
  const RgbdFrame frame = frameOf(keyframe);
  if (tracker_ == nullptr || !sameCamera(frame.intrinsics, camera_)) {
    camera_ = frame.intrinsics;
    preprocessor_ = std::make_unique<DepthPreprocessor>(compute_, ofViews(first_.parameters().preprocessing),
                                                        camera_, first_.parameters().depth_sensor);
    tracker_ = std::make_unique<IcpTracker>(compute_, first_.parameters().icp_tracking, camera_);
  }
  StageTimers timers;
  const TrackingResult result = tracker_->track(preprocessor_->process(frame), first_.render(T_A_D),
                                                {T_A_D, std::nullopt, "overlap"}, timers);
  return result.status == TrackingStatus::kTracking ? result.T_W_D : T_A_D;
}

MapOverlap overlapOf(const std::vector<Fit>& fits, const LoopParameters& loops) {
  MapOverlap overlap;
  overlap.fitting = fits.size();
  std::vector<Fit> best;
  for (const Fit& fit : fits) {
    std::vector<Fit> agreeing = agreeingWith(fit.T_A_B, fits, loops);
    if (agreeing.size() > best.size()) best = std::move(agreeing);
  }
  overlap.agreeing = best.size();
  if (best.empty()) return overlap;
  overlap.T_A_B = meanOf(best);
  double squares = 0.0;
  for (const Fit& fit : best) squares += std::pow(apart_m(fit, overlap.T_A_B), 2);
  overlap.spread_m = std::sqrt(squares / static_cast<double>(best.size()));
  return overlap;
}

void checkOverlap(const MapOverlap& overlap, const LoopParameters& loops, const OpenMap& first,
                  const OpenMap& second) {
  const std::string of_both = second.name() + " and " + first.name();
  check(overlap.agreeing >= static_cast<size_t>(loops.agreeing_loops),
        of_both + " show no overlap: of " + std::to_string(second.loaded().keyframes.size()) + " keyframes " +
            std::to_string(overlap.fitting) + " fit, and " + std::to_string(overlap.agreeing) +
            " agree on where, where loops/agreeing_loops asks for " + std::to_string(loops.agreeing_loops) +
            "; nothing is merged");
  const double elsewhere = 1.0 - static_cast<double>(overlap.agreeing) / static_cast<double>(overlap.fitting);
  check(elsewhere <= kMostElsewhere, of_both + " fit in several ways that cannot both be: of " +
                                         std::to_string(overlap.fitting) + " keyframes that fit, only " +
                                         std::to_string(overlap.agreeing) +
                                         " agree; places in them may look alike; nothing is merged");
}

}  // namespace depth_fusion
