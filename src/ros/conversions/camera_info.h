// What a camera_info says of a camera's images. Bags and live topics read it here.
#pragma once

#include <sensor_msgs/CameraInfo.h>

#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "depth_fusion/geometry/lens_distortion.h"

namespace depth_fusion {

struct CameraModel {
  CameraIntrinsics intrinsics;  // of the images as they are; fy < 0 as the message has it
  LensDistortion lens;          // of the images; none if they are rectified
  std::string remark;           // what the user should know of how the message was read, or empty
};

// Reads the message for images of this size. P counts for rectified images (whose topic's name says so) and K
// for others, and each where the other is none. Binning and ROI are taken into account where the images show
// them. Throws Error that begins with `info_topic` and names the numbers and both sizes if this cannot be the
// camera of such images, or if its lens model is not known.
CameraModel cameraFromInfo(const sensor_msgs::CameraInfo& info, const std::string& info_topic,
                           const std::string& image_topic, cv::Size image_size);

// The size of the images that the message is for, by its binning and ROI.
cv::Size imageSizeOf(const sensor_msgs::CameraInfo& info);

struct ColorCamera {
  std::optional<CameraIntrinsics> intrinsics;  // where they are not the depth camera's
  LensDistortion lens;
  bool is_registered = true;  // to depth: no message says anything else
  std::string remark;         // as CameraModel's
  std::string problem;        // why colour is to be left out; empty if it can be used
};

// Reads the colour camera's message, as cameraFromInfo does; what is wrong with it is a problem of colour
// alone. Colour without a message (null), or with one that says nothing (focal lengths of 0), is registered
// to depth.
ColorCamera colorCameraFromInfo(const sensor_msgs::CameraInfo* info, const std::string& info_topic,
                                const std::string& image_topic, cv::Size image_size,
                                const CameraModel& depth_camera);

}  // namespace depth_fusion
