// How the conductor of tracking finds a frame that does not fit the view of the last one.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "depth_fusion/pipeline/tracking_session.h"
#include "pipeline/search_poses.h"

namespace depth_fusion {
namespace {

constexpr int kPlacesInAFrame = 4;  // that a lost sensor is searched for in, farther about its last pose

// A frame whose depth says nothing of where it is.
TrackingResult lostWithout(const GuessedMotion& motion) {
  char reason[300];
  std::snprintf(
      reason, sizeof(reason),
      "the sensor may have moved by %.1f m along what geometry leaves free: places there may look alike, "
      "and only texture or a pose that is given can tell them apart",
      motion.m());
  TrackingResult result;
  result.reason = reason;
  return result;
}

}  // namespace

void TrackingSession::noteLoss(const RgbdFrame& frame, const FrameFeatures& features) {
  const bool goes_on = loss_ && frame.stamp_s >= loss_->until_s;
  const bool sees_enough =
      features.reason.empty() && pointsInRange(frame) >= parameters_.icp_tracking.min_inliers;
  loss_ = {goes_on ? loss_->since_s : frame.stamp_s, frame.stamp_s, sees_enough};
}

bool TrackingSession::isLostForLong() const {
  const double lost_s = static_cast<double>(parameters_.relocalisation.lost_s);
  return lost_s > 0.0 && loss_ && loss_->sees_enough && loss_->until_s - loss_->since_s >= lost_s;
}

TrackingResult TrackingSession::relocalise(const MotionPrior& prior, const FrameFeatures& features,
                                           const TrackingResult& lost, StageTimers& timers) {
  const StageTimers::Scope timer(timers, "relocalisation");
  if (given_) {
    TrackingResult result = searchAtGiven(timers);
    if (result.status != TrackingStatus::kLost) return result;
  }
  for (const KeyframePtr& keyframe : relocaliser_.candidates(features)) {
    const TextureOdometryResult motion = matcher_.match(keyframe->features, features, true);
    if (!motion.found) continue;
    TrackingResult result = trackFrom(motion.priorFrom(keyframe->T_W_D), timers);
    if (result.status != TrackingStatus::kLost) return result;
  }
  if (motion_.isTracking()) return lost;
  const std::optional<MotionPrior> bridged = motion_.bridged();
  if (guessed_.isAnywhere() && !bridged) return lostWithout(guessed_);
  TrackingResult result = trackFrom(prior, timers);
  std::vector<MotionPrior> starts = motion_.otherStarts();
  const auto is_the_prior = [&](const MotionPrior& start) { return saysTheSame(start, prior); };
  if (std::none_of(starts.begin(), starts.end(), is_the_prior)) starts.push_back(prior);
  for (size_t i = 0; i < starts.size() && result.status == TrackingStatus::kLost; ++i)
    result = searchAbout(starts[i], timers);
  if (result.status != TrackingStatus::kLost) return result;
  const std::vector<Pose> poses = bridged ? aboutBridged(*bridged) : aboutLastSeen(starts.front().T_W_D);
  return poses.empty() ? result : searchFarther(poses, timers);
}

TrackingResult TrackingSession::searchFarther(const std::vector<Pose>& poses, StageTimers& timers) {
  TrackingResult result;
  for (int i = 0; i < kPlacesInAFrame && result.status == TrackingStatus::kLost; ++i)
    result = searchAbout({poses[next_search_++ % poses.size()], std::nullopt, "search"}, timers);
  return result;
}

TrackingResult TrackingSession::searchAbout(const MotionPrior& start, StageTimers& timers) {
  return orStillLost(tracker_.search(*depth_, render_(start.T_W_D), start, timers));
}

TrackingResult TrackingSession::searchAtGiven(StageTimers& timers) {
  TrackingResult best;
  for (const Pose& T_W_D : aboutGiven(given_->T_W_D)) {
    const TrackingResult result = searchAbout({T_W_D, std::nullopt, "given pose"}, timers);
    if (result.status != TrackingStatus::kLost && result.explained > best.explained) best = result;
  }
  if (--given_->frames_left == 0) given_.reset();
  return best;
}

TrackingResult TrackingSession::trackFrom(const MotionPrior& prior, StageTimers& timers) {
  return orStillLost(tracker_.track(*depth_, render_(prior.T_W_D), prior, {}, timers));
}

TrackingResult TrackingSession::orStillLost(TrackingResult result) const {
  result = tracker_.orStillLost(lostIfGuessed(std::move(result)));
  if (result.status == TrackingStatus::kLost ||
      result.inlier_fraction >= parameters_.relocalisation.min_inlier_fraction) {
    return result;
  }
  result.status = TrackingStatus::kLost;
  result.reason = "still lost: only " + std::to_string(std::lround(100.0 * result.inlier_fraction)) +
                  " % of the points fit the map";
  return result;
}

}  // namespace depth_fusion
