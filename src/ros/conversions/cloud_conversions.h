// Point clouds as the images of the camera that took them.
#pragma once

#include <sensor_msgs/PointCloud2.h>

#include <opencv2/core.hpp>
#include <string>

#include "depth_fusion/geometry/camera_intrinsics.h"

namespace depth_fusion {

// A cloud whose points stand in the rows and columns of an image, as RGB-D drivers publish it; others (height
// 1) are lists.
bool isOrganised(const sensor_msgs::PointCloud2& cloud);

// All of these take x, y and z of 32-bit floats, metres in an optical frame. `topic` begins the message of
// every Error.

// The pinhole camera by whose pixels an organised cloud's points lie, to half a pixel. Throws Error where
// there is none, or too few points to tell.
CameraIntrinsics cameraOfCloud(const sensor_msgs::PointCloud2& cloud, const std::string& topic);

// Whether that is the camera of the cloud, as a part of the points tells.
bool isCameraOf(const CameraIntrinsics& camera, const sensor_msgs::PointCloud2& cloud,
                const std::string& topic);

// The depth of an organised cloud's points: CV_32FC1, NaN where there is none.
cv::Mat depthOfCloud(const sensor_msgs::PointCloud2& cloud, const std::string& topic);

// The field rgb (or rgba) of an organised cloud as CV_8UC3 BGR, else its field intensity, from 0 to 255, as
// CV_8UC1, else empty.
cv::Mat colorOfCloud(const sensor_msgs::PointCloud2& cloud);

// What a camera would measure of a list of points, the nearest in each pixel: CV_32FC1, NaN where there is
// none.
cv::Mat depthOfPoints(const sensor_msgs::PointCloud2& cloud, const CameraIntrinsics& camera,
                      const std::string& topic);

}  // namespace depth_fusion
