// Pieces of HTML: texts, numbers and pictures.
#pragma once

#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace depth_fusion {

// The text with what HTML would read as marks written as entities, for texts and attributes in quotes.
std::string escaped(const std::string& text);

// The number with so many decimals.
std::string fixed(double value, int decimals);

// The number in groups of three digits: "2,188,697".
std::string grouped(size_t number);

// Bytes as people read them: "512 kB", "34 MB", "1.2 GB".
std::string bytesText(double bytes);

// A share of the whole in percent.
std::string percentText(double part, double whole);

std::string base64(const std::vector<uint8_t>& bytes);

// The picture, CV_8UC3 BGR or CV_8UC1, as the address of an image that is within the page.
std::string jpegAddress(const cv::Mat& picture);

}  // namespace depth_fusion
