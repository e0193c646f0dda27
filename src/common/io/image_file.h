// Image files, read and written so that a damaged one is an Error and never a half-filled image.
#pragma once

#include <cstddef>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

namespace depth_fusion {

using Bytes = std::vector<unsigned char>;

// Whether the data begin as those of a PNG do.
bool beginsAsPng(const unsigned char* data, size_t size);

// Decodes a PNG, JPEG or other image that OpenCV knows, with its depth and channels unchanged. Throws Error,
// which begins with `name`, for one that is truncated or corrupt.
cv::Mat decodeImage(const unsigned char* data, size_t size, const std::string& name);

// The image as RgbdFrame::color has it: CV_8UC3 BGR or CV_8UC1. Throws as decodeImage.
cv::Mat decodeColorImage(const unsigned char* data, size_t size, const std::string& name);

// A depth image of one channel with 16 bits. Throws Error naming the file.
cv::Mat readDepthImage(const std::string& path);

// A colour image as decodeColorImage gives it. Throws Error naming the file.
cv::Mat readColorImage(const std::string& path);

struct PngHeader {
  cv::Size size;
  bool is_depth = false;  // one channel of 16 bits
};

// The header of a PNG file, or nothing if there is no such file or it is none.
std::optional<PngHeader> readPngHeader(const std::string& path);

// The size that most of the first nine PNG files have. Throws Error, which begins with `list` and ends with
// the remark, if none of the paths is such a file, or none a depth image.
cv::Size usualDepthSize(const std::vector<std::string>& paths, const std::string& list,
                        const std::string& remark = "");

// Throws Error naming the file if it cannot be written completely.
void writePng(const std::string& path, const cv::Mat& image);

// Writes in the format that the path's ending tells. Throws Error naming the file if it cannot be written.
void writePicture(const std::string& path, const cv::Mat& picture);

}  // namespace depth_fusion
