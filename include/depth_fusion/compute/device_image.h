// Planar float images in device memory; their layout stands in kernels/shared/types.h.
#pragma once

#include <opencv2/core.hpp>

#include "depth_fusion/compute/device_buffer.h"
#include "depth_fusion/geometry/camera_intrinsics.h"

namespace depth_fusion {

// An image of zeros of the camera's size.
DeviceBuffer zeroImage(ComputeContext& compute, const CameraIntrinsics& camera, int planes);

// The image as CV_32F with a channel a plane.
cv::Mat readImage(const DeviceBuffer& image, const CameraIntrinsics& camera, int planes);

// Copies a CV_32F image with a channel a plane, of the camera's size, to the device.
void writeImage(DeviceBuffer& image, const CameraIntrinsics& camera, const cv::Mat& channels);

}  // namespace depth_fusion
