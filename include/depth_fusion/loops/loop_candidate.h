// Two keyframes that may see the same place, and what became of it.
#pragma once

#include <cstdint>
#include <string>

#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

enum class LoopVerdict {
  kOutOfReach,    // the two places are farther apart than drift can be
  kNoView,        // a keyframe has no depth to compare
  kFewMatches,    // hardly a feature looks alike
  kFewInliers,    // the features that look alike agree on no motion
  kDisagreement,  // depth and features say different poses
  kNoOverlap,     // too little of one view lies on the other's surface
  kPoorFit,       // the surfaces are too far apart
  kSeenThrough,   // one view sees through the other's surface
  kWeak,          // neither depth nor texture says some direction well enough
  kBeyondDrift,   // the sensor would have to have drifted by more than it can
  kAmbiguous,     // several places fit that are not the same
  kUnconfirmed,   // fits; keyframes around it have to agree yet
  kClosed,        // is an edge of the graph
  kUndone         // was one, until others contradicted it
};

// What was measured stays at zero if the verdict came before it.
struct LoopCandidate {
  uint32_t old_keyframe = 0, new_keyframe = 0;  // numbers of keyframes
  LoopVerdict verdict = LoopVerdict::kUnconfirmed;
  double likeness = 0.0;  // of the index
  int matches = 0, inliers = 0;
  double disagreement_m = 0.0, disagreement_rad = 0.0;
  double overlap = 0.0;
  double rmse_m = 0.0, rmse_sigmas = 0.0;
  double contradicted = 0.0;
  double sigma_m = 0.0, sigma_rad = 0.0;  // of the pose's weakest direction
  double apart_m = 0.0;                   // the keyframes, by the graph
  double way_m = 0.0;                     // between them, as far as the graph has no shorter one
  double drift_sigmas = 0.0;
  int agreeing = 0;      // keyframes, with this one
  uint32_t closure = 0;  // of a closed one: loops that agree are one closure
  Pose T_old_new = Pose::Identity();
  Matrix6d covariance = Matrix6d::Zero();  // of the twist on the left

  // The verdict and what it is by, in a sentence.
  std::string text() const;
};

const char* nameOf(LoopVerdict verdict);

}  // namespace depth_fusion
