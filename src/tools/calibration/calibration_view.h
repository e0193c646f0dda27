// Shows a frame's depth under the correction so far, on the host.
#pragma once

#include "depth_fusion/preprocessing/depth_preprocessor.h"
#include "tools/calibration/calibration_system.h"
#include "tools/calibration/depth_calibration.h"

namespace depth_fusion {

struct ViewPoint {
  cv::Point pixel;
  Eigen::Vector3d p_D, normal_D;
  double sigma_m;  // of the depth
};

// Holds a frame's depth at half its width and height.
class CalibrationView {
 public:
  // Preprocesses the frame as tracking and fusion do.
  CalibrationView(DepthPreprocessor& preprocessor, const CalibrationFrame& frame);

  // Returns the point at a pixel, or nothing where depth or normal is missing, and outside of the image.
  std::optional<ViewPoint> at(int x, int y) const;
  // Returns what the camera sees where the point falls.
  std::optional<ViewPoint> under(const Eigen::Vector3d& p_D) const;
  // Returns points spread over the image, `columns` of them across its width.
  std::vector<ViewPoint> sample(int columns) const;
  const CameraIntrinsics& camera() const { return camera_; }
  const DepthSensorParameters& sensor() const { return sensor_; }

  // Adds how covector . p_D changes with the calibration's parameters.
  void addDerivatives(const ViewPoint& point, const Eigen::Vector3d& covector, SparseRow& row) const;

 private:
  CameraIntrinsics camera_;
  DepthSensorParameters sensor_;
  Vector6d velocity_;
  cv::Mat depth_m_;  // CV_32FC1
  cv::Mat normals_;  // CV_32FC3
};

}  // namespace depth_fusion
