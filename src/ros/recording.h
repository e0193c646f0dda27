// Opens any recording, bags included.
#pragma once

#include <memory>
#include <string>

#include "depth_fusion/recording/recording.h"

namespace depth_fusion {

// A .bag file, or a folder as openFolder takes it. Throws Error for anything else.
std::unique_ptr<Recording> openRecording(const std::string& path, const RecordingOptions& options);

// Reads a bag: depth as sensor_msgs/Image (16UC1, mono16, 32FC1) or CompressedImage (compressedDepth png), colour as
// Image (rgb8, bgr8, mono8) or CompressedImage (jpeg, png), intrinsics from the CameraInfo beside the depth topic.
// Throws Error naming the topics of the bag if no depth topic or no camera_info is found.
std::unique_ptr<Recording> openBag(const std::string& path, const RecordingOptions& options);

}  // namespace depth_fusion
