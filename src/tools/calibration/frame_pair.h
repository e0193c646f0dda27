// Two frames that see the same surface: point to plane, projective matching.
#pragma once

#include "tools/calibration/calibration_view.h"

namespace depth_fusion {

struct PairResult {
  Pose T_B_A;  // of the frames' depth cameras
  NormalEquations equations;
};

// Aligns the frames from the relative pose T_B_A, which is refined. Returns nothing if too little of A is
// seen in B.
std::optional<PairResult> matchPair(const CalibrationView& a, const CalibrationView& b, const Pose& T_B_A,
                                    double cutoff_sigmas);

}  // namespace depth_fusion
