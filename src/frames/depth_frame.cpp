#include "depth_fusion/frames/depth_frame.h"

#include "shared/types.h"

namespace depth_fusion {

float DepthFrame::maxRange_m() const { return depth_step_m * MEASUREMENT_DEPTH_MAX; }

}  // namespace depth_fusion
