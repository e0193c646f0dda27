// What a bag says of where its cameras stand.
#pragma once

#include <tf2/buffer_core.h>

#include <optional>
#include <string>

#include "depth_fusion/geometry/pose.h"
#include "ros/bags/bag_file.h"

namespace depth_fusion {

// Puts all that the bags' tf says into the buffer.
void addTransforms(const BagFiles& bags, tf2::BufferCore& tf);

// T_target_source by the last word of the bags' tf on it; nothing if tf does not connect the two frames.
std::optional<Pose> transformIn(const BagFiles& bags, const std::string& target, const std::string& source);

}  // namespace depth_fusion
