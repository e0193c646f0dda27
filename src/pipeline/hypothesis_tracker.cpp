#include "depth_fusion/pipeline/hypothesis_tracker.h"

#include <algorithm>
#include <cstdio>

namespace depth_fusion {
namespace {

constexpr int kFewFrames = 5;                // do not say what is usual
constexpr double kMemory_frames = 30.0;      // of how well matches usually fit
constexpr double kShortMemory_frames = 5.0;  // of how much is usually explained
constexpr double kLessExplained = 0.9;       // than usual, from which on other starts are tried
constexpr double kHardlyExplained = 0.7;     // of what is usual, from which on all around is searched
constexpr double kFoundAgain = 0.75;         // of what is usual, from which on a lost sensor is found
constexpr double kUnexplained = 0.55;        // of what is usual, from which on the frame is lost
constexpr double kWellExplained = 0.7;   // of a frame by a map of few frames, so that nothing else is tried
constexpr double kLeastExplained = 0.3;  // of a frame by a map of few frames, else it is lost
constexpr double kWorseMatches = 0.85;   // than usual, from which on the frame is lost
constexpr double kDisagreement = 4.0;    // between prior and depth, in standard deviations
constexpr double kAgreement = 2.0;       // the same, up to which one confirms the other
// What the matches have to say along the weakest direction (weakest_said), for a lost sensor to be found:
// more than in a frame that is tracked, which is known to be near.
constexpr double kSaidWhenFound = 0.55;
// A hypothesis wins over the best one before it if the map explains so much more by it, from as many inliers
// or so.
constexpr double kClearlyMore = 1.03;
constexpr double kComparableInliers = 0.95;

// What is searched around a pose, in steps about as long as ICP's way to a match.
constexpr double kSearchStep_m = 0.08;
constexpr double kSearchStep_rad = 0.06;
constexpr int kSearchSteps = 2;

std::vector<Pose> around(const Pose& T_W_D) {
  std::vector<Pose> poses = {T_W_D};
  for (int step = 1; step <= kSearchSteps; ++step) {
    for (int axis = 0; axis < 6; ++axis) {
      for (const double sign : {-1.0, 1.0}) {
        Vector6d twist = Vector6d::Zero();
        twist[axis] = sign * step * (axis < 3 ? kSearchStep_rad : kSearchStep_m);
        poses.push_back(T_W_D * poseFromTwist(twist));
      }
    }
  }
  return poses;
}

bool isLost(const TrackingResult& result) { return result.status == TrackingStatus::kLost; }

// What is explained is judged over the points that meet the map, so that a sensor that moved on to new
// surface is not held back. A pose by which fewer of them match says nothing by a better share.
bool explainsMore(const TrackingResult& a, const TrackingResult& b) {
  if (isLost(a) || isLost(b)) return !isLost(a);
  if (a.inliers < kComparableInliers * b.inliers) return false;
  return a.explained > kClearlyMore * b.explained;
}

}  // namespace

TrackingResult lostIfGuessed(TrackingResult result) {
  if (isLost(result) || result.guessed_directions == 0) return result;
  result.status = TrackingStatus::kLost;
  result.reason = "the geometry seen leaves free " + result.reason + ", and nothing else helps";
  return result;
}

TrackingResult HypothesisTracker::track(const DepthFrame& frame, const ModelView& view,
                                        const MotionPrior& prior, const std::vector<MotionPrior>& others,
                                        StageTimers& timers) {
  TrackingResult best = align(frame, view, prior, timers);
  if (isConvincing(best)) return best;
  const TrackingResult first = best;
  for (const MotionPrior& other : others) {
    if (saysTheSame(other, prior)) continue;
    TrackingResult result = align(frame, view, other, timers);
    if (explainsMore(result, best)) best = std::move(result);
  }
  if (!fitsAsUsual(best) || best.explained < explainedBy(kWellExplained, kHardlyExplained)) {
    for (const MotionPrior& other : others) {
      TrackingResult result = search(frame, view, other, timers);
      if (explainsMore(result, best)) best = std::move(result);
    }
  }
  if (best.prior != first.prior && prior.covariance) {
    best.dropped_prior = first.prior;
    best.prior_sigmas = first.prior_sigmas;
  }
  const bool is_unexplained = best.explained < explainedBy(kLeastExplained, kUnexplained);
  return is_unexplained && !isConfirmed(best, prior) ? lost(std::move(best)) : orLost(std::move(best));
}

TrackingResult HypothesisTracker::align(const DepthFrame& frame, const ModelView& view, MotionPrior prior,
                                        StageTimers& timers) {
  if (!attitude_.empty()) attitude_.addTo(prior);
  return tracker_.track(frame, view, prior, timers);
}

TrackingResult HypothesisTracker::search(const DepthFrame& frame, const ModelView& view,
                                         const MotionPrior& start, StageTimers& timers) {
  const Pose T_W_D = tracker_.bestStart(frame, view, around(start.T_W_D), timers);
  return orLost(lostIfGuessed(align(frame, view, {T_W_D, std::nullopt, "search"}, timers)));
}

TrackingResult HypothesisTracker::compare(const DepthFrame& frame, const ModelView& view, const Pose& T_W_D,
                                          StageTimers& timers) {
  const MotionPrior start{T_W_D, std::nullopt, "comparison"};
  const TrackingResult near = align(frame, view, start, timers);
  const bool fits = !isLost(near) && near.explained >= kHardlyExplained * usual_.explained;
  return fits ? near : search(frame, view, start, timers);
}

TrackingResult HypothesisTracker::orStillLost(TrackingResult result) const {
  if (result.explained < explainedBy(kLeastExplained, kFoundAgain)) return lost(std::move(result));
  if (isLost(result) || result.weakest_said >= kSaidWhenFound) return result;
  char reason[200];
  std::snprintf(reason, sizeof(reason),
                "places may look alike: along one direction the matches say %.0f %% of what the frame's "
                "points would, and %.0f %% are asked of a sensor that is lost",
                100.0 * result.weakest_said, 100.0 * kSaidWhenFound);
  result.status = TrackingStatus::kLost;
  result.reason = reason;
  return result;
}

void HypothesisTracker::accept(const TrackingResult& result) {
  if (!(result.inlier_fraction > 0.0)) return;  // the first frame of a map
  ++usual_.frames;
  const auto average = [this](double& mean, double value, double memory_frames) {
    mean += std::max(1.0 / usual_.frames, 1.0 / memory_frames) * (value - mean);
  };
  average(usual_.explained, result.explained, kShortMemory_frames);
  average(usual_.match_quality, result.match_quality, kMemory_frames);
}

double HypothesisTracker::explainedBy(double few_frames, double of_usual) const {
  return usual_.frames < kFewFrames ? few_frames : of_usual * usual_.explained;
}

bool HypothesisTracker::isConvincing(const TrackingResult& result) const {
  return fitsAsUsual(result) && result.prior_sigmas < kDisagreement &&
         result.explained >= explainedBy(kWellExplained, kLessExplained);
}

bool HypothesisTracker::isConfirmed(const TrackingResult& result, const MotionPrior& prior) const {
  return usual_.frames < kFewFrames && prior.covariance && result.prior == prior.origin &&
         result.prior_sigmas < kAgreement;
}

bool HypothesisTracker::fitsAsUsual(const TrackingResult& result) const {
  return !isLost(result) && result.match_quality >= kWorseMatches * usual_.match_quality;
}

TrackingResult HypothesisTracker::orLost(TrackingResult result) const {
  return fitsAsUsual(result) ? result : lost(std::move(result));
}

TrackingResult HypothesisTracker::lost(TrackingResult result) const {
  if (isLost(result)) return result;
  char reason[300];
  std::snprintf(
      reason, sizeof(reason),
      "the best pose found may be a wrong one: the map explains %.0f %% of the points, where %.0f %% is "
      "usual, and fits those that match by %.2f, where %.2f is usual",
      100.0 * result.explained, 100.0 * usual_.explained, result.match_quality, usual_.match_quality);
  result.status = TrackingStatus::kLost;
  result.reason = reason;
  return result;
}

}  // namespace depth_fusion
