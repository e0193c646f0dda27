#include "tools/plots/calibration_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

#include "depth_fusion/preprocessing/depth_correction.h"

namespace depth_fusion {
namespace {

const cv::Size kPanel(320, 240);
constexpr int kGap_px = 16;
constexpr int kTitle_px = 36;
constexpr int kScale_px = 60;
const cv::Scalar kOutline(40, 40, 40);

// Colours go from blue over white to red; what is unknown is grey.
cv::Vec3b colorOf(float value, double limit) {
  if (std::isnan(value)) return {200, 200, 200};
  const double part = std::clamp(value / limit, -1.0, 1.0);
  const auto faded = static_cast<uchar>(std::lround(255.0 * (1.0 - std::abs(part))));
  return part > 0.0 ? cv::Vec3b(faded, faded, 255) : cv::Vec3b(255, faded, faded);
}

void write(cv::Mat& picture, const std::string& text, const cv::Point& at) {
  cv::putText(picture, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.45, kOutline, 1, cv::LINE_AA);
}

void drawPanel(cv::Mat& picture, int number, const std::string& title, const cv::Mat& values_per_m,
               double limit) {
  cv::Mat colors(values_per_m.size(), CV_8UC3);
  for (int y = 0; y < colors.rows; ++y) {
    for (int x = 0; x < colors.cols; ++x)
      colors.at<cv::Vec3b>(y, x) = colorOf(values_per_m.at<float>(y, x), limit);
  }
  const cv::Rect place(cv::Point(kGap_px + number * (kPanel.width + kGap_px), kTitle_px), kPanel);
  cv::resize(colors, picture(place), kPanel, 0, 0, cv::INTER_NEAREST);
  cv::rectangle(picture, place, kOutline);
  write(picture, title, {place.x, kTitle_px - 12});
}

void drawScale(cv::Mat& picture) {
  const cv::Rect place(kGap_px, kTitle_px + kPanel.height + 16, kPanel.width, 14);
  for (int x = 0; x < place.width; ++x) {
    const float part = 2.0f * static_cast<float>(x) / static_cast<float>(place.width);
    picture(cv::Rect(place.x + x, place.y, 1, place.height)).setTo(colorOf(part - 1.0f, 1.0));
  }
  cv::rectangle(picture, place, kOutline);
  write(picture, "blue: too near, red: too far, at 1 m (at 2 m four times that); grey: no plane",
        {place.br().x + 12, place.br().y - 2});
}

std::string millimetres(double metres) {
  char text[50];
  std::snprintf(text, sizeof(text), "%.1f mm", 1e3 * metres);
  return text;
}

// Returns the largest magnitude, rounded up to whole millimetres.
double limitOf(const cv::Mat& values_per_m) {
  float largest = 0.0f;
  for (const float value : cv::Mat_<float>(values_per_m))
    largest = std::max(largest, std::isnan(value) ? 0.0f : std::abs(value));
  return std::max(std::ceil(1e3 * largest), 1.0) / 1e3;
}

}  // namespace

cv::Mat drawCalibration(const DepthCalibration& calibration) {
  const DepthResiduals &before = calibration.before, &after = calibration.after;
  const cv::Mat correction = spreadOffsets(calibration.offsets_per_m, kPanel);
  const double limit = limitOf(before.map_per_m), correction_limit = limitOf(correction);
  cv::Mat picture(kTitle_px + kPanel.height + kScale_px, 3 * kPanel.width + 4 * kGap_px, CV_8UC3,
                  cv::Scalar::all(255));
  drawPanel(picture, 0, "planes before: " + millimetres(before.rms_per_m) + " RMS, +-" + millimetres(limit),
            before.map_per_m, limit);
  drawPanel(picture, 1, "planes after: " + millimetres(after.rms_per_m) + " RMS, +-" + millimetres(limit),
            after.map_per_m, limit);
  drawPanel(picture, 2, "correction: +-" + millimetres(correction_limit), correction, correction_limit);
  drawScale(picture);
  return picture;
}

}  // namespace depth_fusion
