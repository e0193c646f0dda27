// What the inverse depth lacks, by part of the image, apart from noise.
#pragma once

#include "tools/calibration/depth_calibration.h"

namespace depth_fusion {

class ResidualMap {
 public:
  // Adds a residual of the inverse depth at a pixel of the camera's image.
  void add(const cv::Point& pixel, const CameraIntrinsics& camera, double residual_per_m, double weight);
  DepthResiduals residuals() const;

 private:
  static constexpr int kColumns = 20, kRows = 15;

  cv::Mat sums_ = cv::Mat::zeros(kRows, kColumns, CV_64FC1);
  cv::Mat weights_ = cv::Mat::zeros(kRows, kColumns, CV_64FC1);
  cv::Mat counts_ = cv::Mat::zeros(kRows, kColumns, CV_32SC1);
};

}  // namespace depth_fusion
