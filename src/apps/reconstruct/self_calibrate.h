// reconstruct --self-calibrate
#pragma once

#include "apps/reconstruct/run.h"

namespace depth_fusion {

// Calibrates the depth sensor from the recording itself and says what was found. Returns the options with
// what is applied, or as they are, saying why, if the recording cannot tell.
RunOptions selfCalibrated(const RunOptions& options);

}  // namespace depth_fusion
