// What a pose graph's poses are to fit, with derivatives. Nodes are twists that are applied on the right of
// the poses that they begin with, so that the problem is one over vectors in every version of Ceres.
#pragma once

#include <ceres/sized_cost_function.h>

#include "depth_fusion/loops/pose_graph.h"

namespace depth_fusion {

// The rotation vector of exp(r) exp(d) is r + inverseRightJacobian(r) d to first order, and exp(r + d) is
// exp(r) exp(rightJacobian(r) d).
Eigen::Matrix3d rightJacobian(const Eigen::Vector3d& rotation);
Eigen::Matrix3d inverseRightJacobian(const Eigen::Vector3d& rotation);

class EdgeCost : public ceres::SizedCostFunction<6, 6, 6> {
 public:
  EdgeCost(const GraphEdge& edge, const Pose& T_W_from, const Pose& T_W_to);

  // The factor of the residual; 0: the edge does not count.
  void setWeight(double weight) { weight_ = weight; }

  bool Evaluate(double const* const* twists, double* residual, double** jacobians) const override;

 private:
  Pose T_from_to_start_, T_to_from_measured_;
  Matrix6d root_information_;  // of the twist on the right of the measured motion
  double weight_ = 1.0;
};

class GravityCost : public ceres::SizedCostFunction<3, 6> {
 public:
  GravityCost(const Pose& T_W_D, const Eigen::Vector3d& down_D, const Eigen::Vector3d& down_W,
              double sigma_rad);

  bool Evaluate(double const* const* twists, double* residual, double** jacobians) const override;

 private:
  Eigen::Vector3d down_D_start_, down_D_;
  double sigma_rad_;
};

}  // namespace depth_fusion
