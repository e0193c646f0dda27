// A recording whose cameras are as the user says.
#pragma once

#include <memory>

#include "depth_fusion/recording/recording.h"

namespace depth_fusion {

// Gives every frame the lens distortion, the depth unit and the colour camera of the options, and y down.
// Colour without a camera of its own is registered to depth, and has been through the same lens.
std::unique_ptr<Recording> calibrated(std::unique_ptr<Recording> recording, const RecordingOptions& options);

}  // namespace depth_fusion
