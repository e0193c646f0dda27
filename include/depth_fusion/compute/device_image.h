// Images of four-byte pixels in device memory; their layout stands in kernels/shared/types.h.
#pragma once

#include <opencv2/core.hpp>

#include "depth_fusion/compute/compute_context.h"
#include "depth_fusion/compute/device_buffer.h"
#include "depth_fusion/geometry/camera_intrinsics.h"

namespace depth_fusion {

// An image of zeros of the camera's size.
DeviceBuffer zeroImage(ComputeContext& compute, const CameraIntrinsics& camera);

// The image as CV_32FC1; words are their bits.
cv::Mat readImage(const DeviceBuffer& image, const CameraIntrinsics& camera);

// An image of packed normals as CV_32FC3; 0 = none.
cv::Mat readNormals(const DeviceBuffer& image, const CameraIntrinsics& camera);

// Copies a CV_32FC1 image of the camera's size to the device.
void writeImage(DeviceBuffer& image, const CameraIntrinsics& camera, const cv::Mat& pixels);

}  // namespace depth_fusion
