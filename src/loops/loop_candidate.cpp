#include "depth_fusion/loops/loop_candidate.h"

#include <cstdio>

namespace depth_fusion {
namespace {

constexpr double kDeg = 180.0 / 3.141592653589793;

template <class... Values>
std::string formatted(const char* format, Values... values) {
  char text[200];
  std::snprintf(text, sizeof(text), format, values...);
  return text;
}

std::string reasonOf(const LoopCandidate& loop) {
  switch (loop.verdict) {
    case LoopVerdict::kOutOfReach:
      return formatted("%.1f m apart after %.1f m of way, farther than drift can be", loop.apart_m,
                       loop.way_m);
    case LoopVerdict::kNoView:
      return "one of them has no depth to compare";
    case LoopVerdict::kFewMatches:
      return formatted("only %d features look alike", loop.matches);
    case LoopVerdict::kFewInliers:
      return formatted("only %d of %d features agree on one motion", loop.inliers, loop.matches);
    case LoopVerdict::kDisagreement:
      return formatted("depth and features disagree by %.0f mm and %.1f degrees", 1e3 * loop.disagreement_m,
                       kDeg * loop.disagreement_rad);
    case LoopVerdict::kNoOverlap:
      return formatted("only %.0f %% of the view lies on the other's surface", 1e2 * loop.overlap);
    case LoopVerdict::kPoorFit:
      return formatted("the surfaces are %.0f mm apart, %.1f sigma", 1e3 * loop.rmse_m, loop.rmse_sigmas);
    case LoopVerdict::kSeenThrough:
      return formatted("%.0f %% of the one's surface is seen through by the other", 1e2 * loop.contradicted);
    case LoopVerdict::kWeak:
      return formatted("the pose is known to %.0f mm and %.1f degrees only", 1e3 * loop.sigma_m,
                       kDeg * loop.sigma_rad);
    case LoopVerdict::kBeyondDrift:
      return formatted("it asks for a drift of %.1f sigma after %.1f m of way", loop.drift_sigmas,
                       loop.way_m);
    case LoopVerdict::kAmbiguous:
      return "other places fit as well";
    case LoopVerdict::kUnconfirmed:
      return formatted("it fits, and %d keyframes say so; others have to agree yet", loop.agreeing);
    case LoopVerdict::kClosed:
      return formatted("%d keyframes agree; %d features, overlap %.0f %%, %.0f mm apart, drift of %.1f sigma",
                       loop.agreeing, loop.inliers, 1e2 * loop.overlap, 1e3 * loop.rmse_m, loop.drift_sigmas);
    case LoopVerdict::kUndone:
      return "other loops contradict it";
  }
  return {};
}

}  // namespace

const char* nameOf(LoopVerdict verdict) {
  constexpr const char* kNames[] = {
      "out of reach", "no view", "few matches",  "few inliers", "disagreement", "no overlap", "poor fit",
      "seen through", "weak",    "beyond drift", "ambiguous",   "unconfirmed",  "closed",     "undone"};
  return kNames[static_cast<int>(verdict)];
}

std::string LoopCandidate::text() const {
  return std::string(nameOf(verdict)) + ": keyframe " + std::to_string(new_keyframe) + " to " +
         std::to_string(old_keyframe) + ", " + reasonOf(*this);
}

}  // namespace depth_fusion
