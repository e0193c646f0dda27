// A recording with the lens distortion taken out of its images.
#pragma once

#include <memory>
#include <vector>

#include "depth_fusion/recording/recording.h"

namespace depth_fusion {

// Depth and colour that is registered to it come as a pinhole camera with the frames' intrinsics sees them; distortion as
// in RecordingOptions; without any it is the recording itself. Throws Error if its size is none that OpenCV knows.
std::unique_ptr<Recording> rectified(std::unique_ptr<Recording> recording, const std::vector<double>& distortion);

}  // namespace depth_fusion
