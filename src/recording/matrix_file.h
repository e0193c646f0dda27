// Files that hold one matrix of numbers.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

// The numbers of a size x size matrix, row by row. Throws Error naming the file if it does not hold so many.
std::vector<double> readMatrixFile(const std::string& path, size_t size);

// The pose of a 4x4 matrix. Nothing for what trackers write where they have none: numbers that are not
// finite, zeros. Throws Error naming the file if it holds no rigid motion.
std::optional<Pose> readPoseFile(const std::string& path);

}  // namespace depth_fusion
