// The lossless compression of depth that compressed_depth_image_transport calls rvl.
#pragma once

#include <cstddef>
#include <opencv2/core.hpp>
#include <string>

namespace depth_fusion {

// A. D. Wilson, "Fast Lossless Depth Image Compression", ISS 2017: width and height (32 bits each), then runs
// of zeros and of differences between neighbours, in numbers of as many nibbles as they need. Gives CV_16UC1.
// Throws Error, which begins with `name`, for data that are cut short or make no image.
cv::Mat decodeRvl(const unsigned char* data, size_t size, const std::string& name);

}  // namespace depth_fusion
