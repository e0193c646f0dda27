// How the conductor of tracking comes to doubt the map.
#include "depth_fusion/pipeline/tracking_session.h"

namespace depth_fusion {
namespace {

// Of a frame's points that match an older view, for it to be compared.
constexpr double kSharedWithOlder = 0.5;

}  // namespace

void TrackingSession::compareWithOlder(double stamp_s, const Pose& T_W_D, const ModelView* view,
                                       StageTimers& timers) {
  if (!watch_.wantsComparison()) return;
  const StageTimers::Scope timer(timers, "comparison");
  TrackingResult by_older;
  if (older_.view() != nullptr) by_older = tracker_.compare(*depth_, *older_.view(), T_W_D, timers);
  const bool is_measured = by_older.status != TrackingStatus::kLost && by_older.guessed_directions == 0 &&
                           by_older.inlier_fraction >= kSharedWithOlder;
  if (!is_measured) older_.keep(view != nullptr ? *view : render_(T_W_D));
  watch_.compare(stamp_s, is_measured ? T_W_D.inverse() * by_older.T_W_D : Pose::Identity());
}

}  // namespace depth_fusion
