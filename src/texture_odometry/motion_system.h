// The normal equations of the motion between two images.
#pragma once

#include "texture_odometry/motion_estimation.h"

namespace depth_fusion {

// A correspondence has up to two residuals, in units of their standard deviations; one is missing where the
// depth is.
struct MotionResiduals {
  std::optional<Eigen::Vector2d> in_reference;  // of the current point
  std::optional<Eigen::Vector2d> in_current;    // of the reference's point
  std::optional<double> depth;
  bool behind_camera = false;

  bool within(const InlierGate& gate) const;
};

// Says how the true noise compares with the assumed one.
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

// Takes a few Gauss-Newton steps over the indexed correspondences. Returns nothing if they do not determine
// the motion.
std::optional<Pose> solveMotion(const MotionModel& model, const std::vector<size_t>& indices,
                                const NoiseScale& noise, const Pose& start, int max_iterations);

}  // namespace depth_fusion
