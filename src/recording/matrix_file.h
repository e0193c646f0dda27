// Files that hold one matrix of numbers.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

// The numbers of a 3x3 matrix, row by row; of a 3x4 or 4x4 matrix, its upper left part. Throws Error naming
// the file if it holds none.
std::vector<double> readCameraMatrixFile(const std::string& path);

// The pose of a 4x4 matrix, or of one without its last row. Nothing for what trackers write where they have
// none: numbers that are not finite, zeros. Throws Error naming the file if it holds no rigid motion.
std::optional<Pose> readPoseFile(const std::string& path);

}  // namespace depth_fusion
