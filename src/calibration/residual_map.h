// What the inverse depth lacks, by part of the image.
#pragma once

#include "depth_fusion/calibration/depth_calibration.h"

namespace depth_fusion {

class ResidualMap {
 public:
  // A residual at a pixel of an image of that size, and its derivative by the pixel's offset.
  void add(const cv::Point& pixel, const CameraIntrinsics& camera, double residual, double by_offset,
           double weight);
  DepthResiduals residuals() const;

 private:
  static constexpr int kColumns = 20, kRows = 15;

  cv::Mat products_ = cv::Mat::zeros(kRows, kColumns, CV_64FC1);
  cv::Mat squares_ = cv::Mat::zeros(kRows, kColumns, CV_64FC1);
  cv::Mat counts_ = cv::Mat::zeros(kRows, kColumns, CV_32SC1);
};

}  // namespace depth_fusion
