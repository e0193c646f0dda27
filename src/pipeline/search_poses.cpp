#include "pipeline/search_poses.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace depth_fusion {

std::vector<Pose> aboutGiven(const Pose& T_W_D) {
  constexpr double kSteps[] = {0.0, -1.0, 1.0};
  constexpr double kStep_m = 0.3, kStep_rad = 0.25;
  std::vector<Pose> poses;
  for (const double aside : kSteps) {
    for (const double ahead : kSteps) {
      for (const double turn : kSteps) {
        Vector6d twist = Vector6d::Zero();
        twist[1] = turn * kStep_rad;
        twist[3] = aside * kStep_m;
        twist[5] = ahead * kStep_m;
        poses.push_back(T_W_D * poseFromTwist(twist));
      }
    }
  }
  return poses;
}

std::vector<Pose> aboutLastSeen(const Pose& T_W_D) {
  constexpr double kTurn_rad = 0.25, kMove_m = 0.3;
  std::vector<Pose> poses;
  const auto add = [&](int axis, double step) {
    Vector6d twist = Vector6d::Zero();
    twist[axis] = step;
    poses.push_back(T_W_D * poseFromTwist(twist));
  };
  for (const double sign : {-1.0, 1.0}) {
    for (int axis = 0; axis < 6; ++axis) add(axis, sign * (axis < 3 ? kTurn_rad : kMove_m));
    for (const int axis : {0, 1}) add(axis, 2.0 * sign * kTurn_rad);
  }
  return poses;
}

std::vector<Pose> aboutBridged(const MotionPrior& prior) {
  constexpr double kReach_m = 0.1, kReach_rad = 0.1;  // of a search
  constexpr double kFarthest = 2.0;                   // standard deviations
  const Matrix6d to_sensor = adjoint(prior.T_W_D.inverse());
  const Matrix6d covariance = to_sensor * *prior.covariance * to_sensor.transpose();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> axes(covariance);
  std::vector<Pose> poses;
  for (int axis = 5; axis >= 0; --axis) {
    const Vector6d sigma = std::sqrt(std::max(axes.eigenvalues()(axis), 0.0)) * axes.eigenvectors().col(axis);
    const double reach =
        std::min(kReach_rad / sigma.head<3>().norm(), kReach_m / sigma.tail<3>().norm());  // in sigmas
    for (double steps = reach; std::isfinite(reach) && steps < kFarthest; steps += 2.0 * reach) {
      for (const double sign : {-1.0, 1.0})
        poses.push_back(prior.T_W_D * poseFromTwist(sign * (steps + reach) * sigma));
    }
  }
  return poses;
}

}  // namespace depth_fusion
