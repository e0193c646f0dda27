// Folders of images as recordings, one opener a layout.
#pragma once

#include <memory>
#include <string>

#include "depth_fusion/recording/recording.h"

namespace depth_fusion {

// depth.txt and rgb.txt list "stamp file", or a list of associations "stamp file stamp file"; camera.yaml may
// hold the intrinsics.
bool hasTumLayout(const std::string& folder);
std::unique_ptr<Recording> openTumFolder(const std::string& folder, const RecordingOptions& options);

// frame-XXXXXX.depth.png with .color.png or .color.jpg and .pose.txt beside it.
bool hasSevenScenesLayout(const std::string& folder);
std::unique_ptr<Recording> openSevenScenesFolder(const std::string& folder, const RecordingOptions& options);
// As readPoses.
Trajectory readSevenScenesPoses(const std::string& folder, std::string* remark);

}  // namespace depth_fusion
