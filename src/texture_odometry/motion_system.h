// The normal equations of the motion between two images.
#pragma once

#include "texture_odometry/motion_estimation.h"

namespace depth_fusion {

// Residuals of a correspondence in their standard deviations; none where the depth is missing.
struct MotionResiduals {
  std::optional<Eigen::Vector2d> in_reference;  // of the current point
  std::optional<Eigen::Vector2d> in_current;    // of the reference's point
  std::optional<double> depth;
  bool behind_camera = false;

  bool within(const InlierGate& gate) const;
};

// How the true noise compares with the assumed one.
struct NoiseScale {
  double pixels = 1.0;
  double depth = 1.0;
};

struct MotionSystem {
  Matrix6d hessian = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
};

class MotionModel {
 public:
  MotionModel(const std::vector<Correspondence>& correspondences, const MotionCameras& cameras)
      : correspondences_(correspondences), cameras_(cameras) {}

  const std::vector<Correspondence>& correspondences() const { return correspondences_; }
  MotionResiduals residuals(size_t index, const Pose& T_reference_current) const;

  // Adds a correspondence with robust weights (Cauchy) to the system.
  void accumulate(size_t index, const Pose& T_reference_current, const NoiseScale& noise,
                  MotionSystem& system) const;

 private:
  const std::vector<Correspondence>& correspondences_;
  const MotionCameras& cameras_;
};

// A few Gauss-Newton steps over the indexed correspondences; nothing if the motion is not determined.
std::optional<Pose> solveMotion(const MotionModel& model, const std::vector<size_t>& indices,
                                const NoiseScale& noise, const Pose& start, int max_iterations);

}  // namespace depth_fusion
