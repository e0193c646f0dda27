// Files that OpenNI2 records.
#pragma once

#include <memory>
#include <string>

#include "depth_fusion/recording/recording.h"

namespace depth_fusion {

// An .oni file, every frame of it; intrinsics from its field of view unless the options give them. The file
// does not say whether depth was registered to colour when it was recorded: it is taken to be. Throws Error
// if it cannot be read, or if this build has no OpenNI2.
std::unique_ptr<Recording> openOni(const std::string& path, const RecordingOptions& options);

}  // namespace depth_fusion
