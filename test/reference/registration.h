// The kernels of kernels/registration/, plainly: pixel by pixel, in double.
#pragma once

#include <cmath>
#include <opencv2/core.hpp>

#include "depth_fusion/geometry/lens_distortion.h"
#include "depth_fusion/geometry/pose.h"

namespace depth_fusion::reference {

// Computes where the lens takes the ray (x, y, 1), by OpenCV's model, written down from its documentation.
inline Eigen::Vector2d distorted(const Eigen::Vector2d& ray, LensDistortion k) {
  k.resize(8, 0.0);
  const double x = ray.x(), y = ray.y(), r2 = ray.squaredNorm();
  const double radial = (1.0 + k[0] * r2 + k[1] * r2 * r2 + k[4] * r2 * r2 * r2) /
                        (1.0 + k[5] * r2 + k[6] * r2 * r2 + k[7] * r2 * r2 * r2);
  return {x * radial + 2.0 * k[2] * x * y + k[3] * (r2 + 2.0 * x * x),
          y * radial + k[2] * (r2 + 2.0 * y * y) + 2.0 * k[3] * x * y};
}

class DepthCamera {
 public:
  DepthCamera(const cv::Mat& depth_m, const CameraIntrinsics& camera, const LensDistortion& lens,
              double max_relative_step)
      : depth_m_(depth_m), camera_(camera), lens_(lens), max_relative_step_(max_relative_step) {}

  // Returns the depth along the ray (x, y, 1), interpolated between the pixels that see the same surface as
  // the nearest one; 0 = none.
  double along(const Eigen::Vector2d& ray) const {
    const Eigen::Vector2d bent = distorted(ray, lens_);
    const double u = camera_.fx * bent.x() + camera_.cx, v = camera_.fy * bent.y() + camera_.cy;
    const double nearest = at(static_cast<int>(std::floor(u + 0.5)), static_cast<int>(std::floor(v + 0.5)));
    if (nearest == 0.0) return 0.0;
    double sum = 0.0, weights = 0.0;
    const int u0 = static_cast<int>(std::floor(u)), v0 = static_cast<int>(std::floor(v));
    for (int y = v0; y <= v0 + 1; ++y) {
      for (int x = u0; x <= u0 + 1; ++x) {
        // The image's last row goes on beyond its border, as the kernel has it.
        const double z = at(x, std::clamp(y, 0, camera_.height - 1));
        if (z == 0.0 || std::abs(z - nearest) > max_relative_step_ * nearest) continue;
        const double weight = (1.0 - std::abs(u - x)) * (1.0 - std::abs(v - y));
        sum += weight * z;
        weights += weight;
      }
    }
    return sum / weights;
  }

 private:
  double at(int x, int y) const {
    const bool inside = x >= 0 && y >= 0 && x < camera_.width && y < camera_.height;
    return inside ? depth_m_.at<float>(y, x) : 0.0;
  }

  const cv::Mat& depth_m_;
  CameraIntrinsics camera_;
  LensDistortion lens_;
  double max_relative_step_;
};

inline Eigen::Vector2d rayOf(const CameraIntrinsics& camera, int x, int y) {
  return {(x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy};
}

inline cv::Mat rectifiedDepth(const DepthCamera& depth, const CameraIntrinsics& camera) {
  cv::Mat result(camera.height, camera.width, CV_32FC1);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x)
      result.at<float>(y, x) = static_cast<float>(depth.along(rayOf(camera, x, y)));
  }
  return result;
}

// Returns, for each pixel of the other camera, the least depth among the points of `rectified` that fall
// within `radius` pixels of it.
inline cv::Mat nearestDepth(const cv::Mat& rectified, const CameraIntrinsics& camera,
                            const CameraIntrinsics& other, const Pose& T_C_D, int radius) {
  cv::Mat nearest(other.height, other.width, CV_64FC1, cv::Scalar(1e9));
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const double z = rectified.at<float>(y, x);
      if (z <= 0.0) continue;
      const Eigen::Vector3d p_C = T_C_D * (z * rayOf(camera, x, y).homogeneous());
      const int u = static_cast<int>(std::lrint(other.fx * p_C.x() / p_C.z() + other.cx));
      const int v = static_cast<int>(std::lrint(other.fy * p_C.y() / p_C.z() + other.cy));
      const bool inside = u >= 0 && v >= 0 && u < other.width && v < other.height;
      if (!inside) continue;
      for (int row = std::max(v - radius, 0); row <= std::min(v + radius, other.height - 1); ++row) {
        for (int column = std::max(u - radius, 0); column <= std::min(u + radius, other.width - 1); ++column)
          nearest.at<double>(row, column) = std::min(nearest.at<double>(row, column), p_C.z());
      }
    }
  }
  return nearest;
}

inline cv::Mat registeredDepth(const DepthCamera& depth, const cv::Mat& nearest,
                               const CameraIntrinsics& other, const Pose& T_C_D, double max_relative_step) {
  const Pose T_D_C = T_C_D.inverse();
  cv::Mat result = cv::Mat::zeros(other.height, other.width, CV_32FC1);
  for (int y = 0; y < other.height; ++y) {
    for (int x = 0; x < other.width; ++x) {
      double z = nearest.at<double>(y, x), step = 1e9;
      if (z > 1e8) continue;
      for (int i = 0; i < 4; ++i) {
        const Eigen::Vector3d p_D = T_D_C * (z * rayOf(other, x, y).homogeneous());
        const double seen = depth.along(p_D.head<2>() / p_D.z());
        step = 1e9;
        if (seen == 0.0) break;
        const double next =
            (seen - T_D_C.translation().z()) / (T_D_C.linear().row(2).dot(rayOf(other, x, y).homogeneous()));
        step = std::abs(next - z);
        z = next;
      }
      if (step <= max_relative_step * z) result.at<float>(y, x) = static_cast<float>(z);
    }
  }
  return result;
}

}  // namespace depth_fusion::reference
