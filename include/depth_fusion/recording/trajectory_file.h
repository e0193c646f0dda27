// Trajectories as text in the TUM format: "stamp tx ty tz qx qy qz qw" a line, '#' starts a comment.
#pragma once

#include <optional>
#include <string>

#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

// Lines whose pose is none (numbers that are not finite, a quaternion of zeros) are left out, other
// quaternions normalised. Throws Error naming the file and line of what cannot be read, or a file without a
// pose. With a remark, lines that cannot be read are left out beside others, and it says which. The poses
// come sorted by stamp.
Trajectory readTrajectory(const std::string& path, std::string* remark = nullptr);

// The poses of a file in the TUM format, or those that a recording's folder holds: groundtruth.txt of the TUM
// layout, frame-XXXXXX.pose.txt of the 7-Scenes layout. Throws Error as readTrajectory, of whole pose files,
// too, or if the folder holds none.
Trajectory readPoses(const std::string& file_or_folder, std::string* remark = nullptr);

// Throws Error if the file cannot be written completely.
void writeTrajectory(const std::string& path, const Trajectory& trajectory);

// The pose at stamp_s of a sorted trajectory: the one with this very stamp, else interpolated between its
// neighbours; nothing unless there is one within max_gap_s on both sides.
std::optional<Pose> poseAt(const Trajectory& trajectory, double stamp_s, double max_gap_s);

}  // namespace depth_fusion
