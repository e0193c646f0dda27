// What RealSense Viewer records beside images, in topics of its own.
#pragma once

#include <optional>
#include <string>

#include "depth_fusion/geometry/pose.h"
#include "ros/bags/bag_file.h"

namespace depth_fusion {

// The unit of the sensor's depth in metres; nothing if the bags do not say it.
std::optional<double> viewerDepthUnit(const BagFiles& bags, const std::string& depth_topic);

// T_color_depth, by the extrinsics of the streams of these images; nothing if there are none.
std::optional<Pose> viewerTransform(const BagFiles& bags, const std::string& color_topic,
                                    const std::string& depth_topic);

}  // namespace depth_fusion
