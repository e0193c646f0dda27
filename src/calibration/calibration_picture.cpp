#include "depth_fusion/calibration/calibration_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

#include "depth_fusion/preprocessing/depth_correction.h"

namespace depth_fusion {
namespace {

const cv::Size kPanel(320, 240);
constexpr int kMargin_px = 16;
constexpr int kTitle_px = 36;
constexpr int kScale_px = 60;
const cv::Scalar kInk(40, 40, 40);

// From blue over white to red; grey for what is unknown.
cv::Vec3b colorOf(float value, double limit) {
  if (std::isnan(value)) return {200, 200, 200};
  const double part = std::clamp(value / limit, -1.0, 1.0);
  const auto faded = static_cast<uchar>(std::lround(255.0 * (1.0 - std::abs(part))));
  return part > 0.0 ? cv::Vec3b(faded, faded, 255) : cv::Vec3b(255, faded, faded);
}

void write(cv::Mat& picture, const std::string& text, const cv::Point& at) {
  cv::putText(picture, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.45, kInk, 1, cv::LINE_AA);
}

void drawPanel(cv::Mat& picture, int number, const std::string& title, const cv::Mat& values_per_m,
               double limit) {
  cv::Mat colors(values_per_m.size(), CV_8UC3);
  for (int y = 0; y < colors.rows; ++y) {
    for (int x = 0; x < colors.cols; ++x)
      colors.at<cv::Vec3b>(y, x) = colorOf(values_per_m.at<float>(y, x), limit);
  }
  const cv::Rect place(cv::Point(kMargin_px + number * (kPanel.width + kMargin_px), kTitle_px), kPanel);
  cv::resize(colors, picture(place), kPanel, 0, 0, cv::INTER_NEAREST);
  cv::rectangle(picture, place, kInk);
  write(picture, title, {place.x, kTitle_px - 12});
}

void drawScale(cv::Mat& picture, double limit) {
  const cv::Rect place(kMargin_px, kTitle_px + kPanel.height + 16, kPanel.width, 14);
  for (int x = 0; x < place.width; ++x) {
    const auto value = static_cast<float>(limit * (2.0 * x / place.width - 1.0));
    picture(cv::Rect(place.x + x, place.y, 1, place.height)).setTo(colorOf(value, limit));
  }
  cv::rectangle(picture, place, kInk);
  char text[100];
  std::snprintf(text, sizeof(text),
                "-%.0f to +%.0f mm too far at 1 m (at 2 m four times as much); grey: not seen", 1e3 * limit,
                1e3 * limit);
  write(picture, text, {place.br().x + 12, place.br().y - 2});
}

std::string withRms(const std::string& name, double rms_per_m) {
  char text[100];
  std::snprintf(text, sizeof(text), "%s: %.1f mm RMS at 1 m", name.c_str(), 1e3 * rms_per_m);
  return text;
}

}  // namespace

cv::Mat drawCalibration(const DepthCalibration& calibration) {
  const DepthResiduals &before = calibration.before, &after = calibration.after;
  const cv::Mat correction = spreadOffsets(calibration.offsets_per_m, kPanel);
  double largest = 0.0;
  cv::minMaxLoc(cv::abs(correction), nullptr, &largest);
  const double limit = std::max(0.005, std::ceil(largest * 200.0) / 200.0);
  cv::Mat picture(kTitle_px + kPanel.height + kScale_px, 3 * kPanel.width + 4 * kMargin_px, CV_8UC3,
                  cv::Scalar::all(255));
  drawPanel(picture, 0, withRms("before", before.rms_per_m), before.map_per_m, limit);
  drawPanel(picture, 1, withRms("after", after.rms_per_m), after.map_per_m, limit);
  drawPanel(picture, 2, "correction", correction, limit);
  drawScale(picture, limit);
  return picture;
}

}  // namespace depth_fusion
