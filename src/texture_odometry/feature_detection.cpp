#include "texture_odometry/feature_detection.h"

#include <algorithm>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <tuple>

#include "texture_odometry/brief.h"

namespace depth_fusion {
namespace {

constexpr int kFastRadius_px = 3;
constexpr double kSmoothing_px = 1.5;

std::vector<cv::KeyPoint> cornersIn(const cv::Mat& grey, const cv::Rect& cell, int threshold) {
  const cv::Point border(kFastRadius_px, kFastRadius_px);
  const cv::Rect seen(cell.tl() - border, cell.br() + border);
  std::vector<cv::KeyPoint> corners;
  cv::FAST(grey(seen), corners, threshold, true);
  for (cv::KeyPoint& corner : corners) corner.pt += cv::Point2f(seen.tl());
  return corners;
}

void keepStrongest(std::vector<cv::KeyPoint>& corners, int count) {
  if (static_cast<int>(corners.size()) <= count) return;
  std::partial_sort(corners.begin(), corners.begin() + count, corners.end(),
                    [](const cv::KeyPoint& a, const cv::KeyPoint& b) {
                      return std::make_tuple(-a.response, a.pt.y, a.pt.x) <
                             std::make_tuple(-b.response, b.pt.y, b.pt.x);
                    });
  corners.resize(count);
}

FeaturePatch patchAbout(const cv::Mat& smoothed, cv::Point pixel) {
  FeaturePatch patch;
  const int radius = kPatchSize_px / 2;
  auto next = patch.begin();
  for (int row = -radius; row <= radius; ++row) {
    const uint8_t* begin = smoothed.ptr<uint8_t>(pixel.y + row) + pixel.x - radius;
    next = std::copy(begin, begin + kPatchSize_px, next);
  }
  return patch;
}

class LevelDetector {
 public:
  LevelDetector(const cv::Mat& grey, const cv::Mat& smoothed, int level,
                const TextureOdometryParameters& parameters)
      : grey_(grey), smoothed_(smoothed), level_(level), parameters_(parameters) {}

  void detect(std::vector<Feature>& features) const {
    const cv::Rect inner(kBriefRadius_px, kBriefRadius_px, grey_.cols - 2 * kBriefRadius_px,
                         grey_.rows - 2 * kBriefRadius_px);
    const int size = parameters_.cell_size_px;
    for (int y = inner.y; y < inner.br().y; y += size) {
      for (int x = inner.x; x < inner.br().x; x += size) {
        for (const cv::KeyPoint& corner : cellCorners(cv::Rect(x, y, size, size) & inner)) {
          const cv::Point pixel = corner.pt;
          features.push_back({level_, pixel, describe(smoothed_, pixel), patchAbout(smoothed_, pixel), {}});
        }
      }
    }
  }

 private:
  // Weak corners count only where there are no others.
  std::vector<cv::KeyPoint> cellCorners(const cv::Rect& cell) const {
    std::vector<cv::KeyPoint> corners = cornersIn(grey_, cell, parameters_.corner_threshold);
    if (corners.empty()) corners = cornersIn(grey_, cell, parameters_.weak_corner_threshold);
    keepStrongest(corners, parameters_.features_per_cell);
    return corners;
  }

  const cv::Mat& grey_;
  const cv::Mat& smoothed_;
  int level_;
  const TextureOdometryParameters& parameters_;
};

}  // namespace

void detectFeatures(const cv::Mat& color, const TextureOdometryParameters& parameters,
                    FrameFeatures& result) {
  cv::Mat grey = color;
  if (color.channels() == 3) cv::cvtColor(color, grey, cv::COLOR_BGR2GRAY);
  for (int level = 0; level < parameters.levels; ++level) {
    if (level > 0) cv::resize(grey, grey, cv::Size(grey.cols / 2, grey.rows / 2), 0.0, 0.0, cv::INTER_AREA);
    if (std::min(grey.cols, grey.rows) <= 2 * kBriefRadius_px) return;
    cv::Mat smoothed;
    cv::GaussianBlur(grey, smoothed, cv::Size(7, 7), kSmoothing_px);
    LevelDetector(grey, smoothed, level, parameters).detect(result.features);
    result.smoothed_levels.push_back(smoothed);
  }
}

}  // namespace depth_fusion
