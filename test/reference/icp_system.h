// The system of kernels/icp_tracking/accumulate_system.cl, plainly: pixel by pixel, in double, the Jacobian
// by central differences of the residual.
#pragma once

#include <array>
#include <cmath>
#include <opencv2/core.hpp>

#include "depth_fusion/geometry/camera_intrinsics.h"
#include "icp_tracking/icp_system.h"
#include "reference/depth_preprocessing.h"

namespace depth_fusion::reference {

struct OrientedDepth {
  CameraIntrinsics camera;
  cv::Mat depth, normals;  // CV_32FC1, CV_32FC3

  Eigen::Vector3d point(int x, int y) const {
    const double z = depth.at<float>(y, x);
    return {(x - camera.cx) / camera.fx * z, (y - camera.cy) / camera.fy * z, z};
  }
  Eigen::Vector3d normal(int x, int y) const {
    const cv::Vec3f n = normals.at<cv::Vec3f>(y, x);
    return {n[0], n[1], n[2]};
  }
  bool has(int x, int y) const {
    return depth.at<float>(y, x) > 0.0f && normals.at<cv::Vec3f>(y, x)[2] != 0.0f;
  }
};

class IcpReference {
 public:
  IcpReference(const OrientedDepth& model, const Pose& T_M_D, double max_distance_m, double min_normal_cosine,
               double huber_sigmas)
      : model_(model),
        T_M_D_(T_M_D),
        max_distance_m_(max_distance_m),
        min_normal_cosine_(min_normal_cosine),
        huber_sigmas_(huber_sigmas) {
    for (int i = 0; i < 6; ++i) {
      forward_[i] = poseFromTwist(kStep * Vector6d::Unit(i));
      backward_[i] = poseFromTwist(-kStep * Vector6d::Unit(i));
    }
  }

  IcpSystem accumulate(const OrientedDepth& source) {
    for (int y = 0; y < source.camera.height; ++y) {
      for (int x = 0; x < source.camera.width; ++x) {
        if (!source.has(x, y)) continue;
        ++system_.source_points;
        addPoint(source.point(x, y), source.normal(x, y));
      }
    }
    return system_;
  }

 private:
  static constexpr double kStep = 1e-4;

  void addPoint(const Eigen::Vector3d& p_D, const Eigen::Vector3d& normal_D) {
    const Eigen::Vector3d p = T_M_D_ * p_D;
    if (p.z() <= 0.0) return;
    const double u = std::floor(model_.camera.fx * p.x() / p.z() + model_.camera.cx + 0.5);
    const double v = std::floor(model_.camera.fy * p.y() / p.z() + model_.camera.cy + 0.5);
    if (u < 0.0 || v < 0.0 || u >= model_.camera.width || v >= model_.camera.height) return;
    const int x = static_cast<int>(u);
    const int y = static_cast<int>(v);
    if (!model_.has(x, y)) return;
    ++system_.covered_points;
    const Eigen::Vector3d q = model_.point(x, y);
    const Eigen::Vector3d n = model_.normal(x, y);
    if ((p - q).norm() >= max_distance_m_ || n.dot(T_M_D_.linear() * normal_D) <= 0.0) return;
    const double sigma = sensorSigma(p_D.z());
    const double huber = std::min(1.0, huber_sigmas_ * sigma / std::max(std::abs(n.dot(p - q)), 1e-6));
    addMatch({p, q, n, T_M_D_.linear() * normal_D}, huber * std::pow(ICP_UNIT_SIGMA_M / sigma, 2), sigma);
  }

  // The points p of the source and q of the model, and their normals.
  struct Match {
    Eigen::Vector3d p, q, model_normal, source_normal;
  };

  Vector6d jacobianAlong(const Eigen::Vector3d& normal, const Match& match) const {
    Vector6d jacobian;
    for (int i = 0; i < 6; ++i)
      jacobian[i] = normal.dot(forward_[i] * match.p - backward_[i] * match.p) / (2.0 * kStep);
    return jacobian;
  }

  void addMatch(const Match& match, double weight, double sigma) {
    const double r = match.model_normal.dot(match.p - match.q);
    const Vector6d jacobian = jacobianAlong(match.model_normal, match);
    const Matrix6d product = jacobian * jacobianAlong(match.source_normal, match).transpose();
    system_.structure += weight * 0.5 * (product + product.transpose());
    if (match.model_normal.dot(match.source_normal) <= min_normal_cosine_) return;
    system_.hessian += weight * jacobian * jacobian.transpose();
    system_.gradient += weight * r * jacobian;
    system_.squared_residuals += weight * r * r;
    system_.weights += weight;
    ++system_.inliers;
    system_.fit += std::max(0.0, 1.0 - std::pow(r / (ICP_FIT_SIGMAS * sigma), 2));
  }

  const OrientedDepth& model_;
  Pose T_M_D_;
  double max_distance_m_, min_normal_cosine_, huber_sigmas_;
  std::array<Pose, 6> forward_, backward_;
  IcpSystem system_;
};

}  // namespace depth_fusion::reference
