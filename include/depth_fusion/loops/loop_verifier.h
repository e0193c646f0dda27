// Whether two keyframes see the same place, by what they show alone.
#pragma once

#include "depth_fusion/loops/loop_candidate.h"
#include "depth_fusion/loops/loop_parameters.h"
#include "depth_fusion/relocalisation/keyframe.h"

namespace depth_fusion {

class LoopVerifier {
 public:
  explicit LoopVerifier(const LoopParameters& parameters);

  // Fills in what is measured of the loop from `old_keyframe` to `new_keyframe`: features that look alike
  // give a pose, to which ICP between the views, and what each sees through, must agree. Returns whether it
  // fits; its verdict is then kUnconfirmed.
  bool verify(const Keyframe& old_keyframe, const Keyframe& new_keyframe, LoopCandidate& loop) const;

 private:
  LoopVerdict verdictOn(const Keyframe& old_keyframe, const Keyframe& new_keyframe,
                        LoopCandidate& loop) const;

  LoopParameters parameters_;
};

}  // namespace depth_fusion
