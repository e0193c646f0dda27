#include "tools/report/html.h"

#include <cmath>
#include <cstdio>
#include <opencv2/imgcodecs.hpp>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

constexpr int kJpegQuality = 88;

}  // namespace

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string fixed(double value, int decimals) {
  char text[64];
  std::snprintf(text, sizeof(text), "%.*f", decimals, value);
  return text;
}

std::string grouped(size_t number) {
  std::string text = std::to_string(number);
  for (size_t at = text.size(); at > 3;) text.insert(at -= 3, ",");
  return text;
}

std::string bytesText(double bytes) {
  if (bytes >= 1e9) return fixed(bytes / 1e9, 2) + " GB";
  if (bytes >= 1e6) return fixed(bytes / 1e6, bytes < 1e7 ? 1 : 0) + " MB";
  return fixed(bytes / 1e3, 0) + " kB";
}

std::string percentText(double part, double whole) {
  const double percent = whole > 0.0 ? 100.0 * part / whole : 0.0;
  return fixed(percent, percent > 0.0 && percent < 10.0 ? 1 : 0) + " %";
}

std::string base64(const std::vector<uint8_t>& bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t three = 0;
    for (size_t k = i; k < i + 3; ++k) three = (three << 8) | (k < bytes.size() ? bytes[k] : 0u);
    for (size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? kDigits[(three >> (6 * (3 - k))) & 63u] : '=';
  }
  return text;
}

std::string jpegAddress(const cv::Mat& picture) {
  std::vector<uint8_t> bytes;
  check(cv::imencode(".jpg", picture, bytes, {cv::IMWRITE_JPEG_QUALITY, kJpegQuality}),
        "a picture cannot be written as JPEG");
  return "data:image/jpeg;base64," + base64(bytes);
}

}  // namespace depth_fusion
