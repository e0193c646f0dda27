// How the conductor of tracking comes to doubt the map.
#include <cstdio>

#include "depth_fusion/pipeline/tracking_session.h"

namespace depth_fusion {
namespace {

// A frame is compared if such a part of its points matches the older view.
constexpr double kSharedWithOlder = 0.5;
// A longer interval does not say how fast the sensor was before it.
constexpr double kSameSpeed_s = 0.11;

// Whether the sensor's motion from a frame's first row to its last makes poses against that frame half as
// wrong as they may be.
bool isBent(const Vector6d& motion) {
  constexpr double kBent_m = 0.025, kBent_rad = 0.026;
  return motion.tail<3>().norm() > kBent_m || motion.head<3>().norm() > kBent_rad;
}

std::string firstFrameBent(const Vector6d& motion) {
  char reason[200];
  std::snprintf(reason, sizeof(reason),
                "its first frame was bent: while it was read the sensor turned by %.1f degrees and moved by "
                "%.0f mm, of which nothing was known then",
                motion.head<3>().norm() * 180.0 / CV_PI, 1e3 * motion.tail<3>().norm());
  return reason;
}

}  // namespace

void TrackingSession::growMap() {
  young_map_.grow();
  const Vector6d bend = parameters_.preprocessing.readout_s * motion_.knownVelocity();
  const bool is_second = young_map_.frames() == 2 && begun_blindly_s_;
  if (is_second && found_->stamp_s - *begun_blindly_s_ < kSameSpeed_s && isBent(bend))
    young_map_.giveUp(firstFrameBent(bend));
}

void TrackingSession::compareWithOlder(double stamp_s, const Pose& T_W_D, const ModelView* view,
                                       StageTimers& timers) {
  if (!watch_.wantsComparison()) return;
  const StageTimers::Scope timer(timers, "comparison");
  TrackingResult by_older;
  if (older_.view() != nullptr) by_older = tracker_.compare(*depth_, *older_.view(), T_W_D, timers);
  const bool is_measured = by_older.status != TrackingStatus::kLost && by_older.guessed_directions == 0 &&
                           by_older.inlier_fraction >= kSharedWithOlder;
  if (is_measured) return watch_.compare(stamp_s, T_W_D.inverse() * by_older.T_W_D);
  if (watch_.waitsForComparison()) return;
  older_.keep(view != nullptr ? *view : render_(T_W_D));
  watch_.compare(stamp_s, Pose::Identity());
}

}  // namespace depth_fusion
