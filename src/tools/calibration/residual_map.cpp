#include "tools/calibration/residual_map.h"

#include <cmath>
#include <limits>

namespace depth_fusion {
namespace {

constexpr int kMinResiduals = 50;  // of a part of the image, for its mean to stand out of the noise

}  // namespace

void ResidualMap::add(const cv::Point& pixel, const CameraIntrinsics& camera, double residual_per_m,
                      double weight) {
  const cv::Point cell(pixel.x * kColumns / camera.width, pixel.y * kRows / camera.height);
  sums_.at<double>(cell) -= weight * residual_per_m;
  weights_.at<double>(cell) += weight;
  ++counts_.at<int>(cell);
}

DepthResiduals ResidualMap::residuals() const {
  DepthResiduals result;
  result.map_per_m = cv::Mat(kRows, kColumns, CV_32FC1, cv::Scalar(std::numeric_limits<float>::quiet_NaN()));
  double squares = 0.0;
  int cells = 0;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      if (counts_.at<int>(row, column) < kMinResiduals || weights_.at<double>(row, column) <= 0.0) continue;
      const double lacking_per_m = sums_.at<double>(row, column) / weights_.at<double>(row, column);
      result.map_per_m.at<float>(row, column) = static_cast<float>(lacking_per_m);
      squares += lacking_per_m * lacking_per_m;
      ++cells;
    }
  }
  if (cells > 0) result.rms_per_m = std::sqrt(squares / cells);
  return result;
}

}  // namespace depth_fusion
