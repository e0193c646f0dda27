#include "icp_tracking/alignment.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <sstream>

#include "icp_tracking/frame_geometry.h"
#include "shared/types.h"

namespace depth_fusion {
namespace {

// No surface leaves more directions free than a plane does, or a sphere.
constexpr int kMostFree = 3;

// The information that the matches hold, of which `correlated` count as one.
IcpSystem weighed(const IcpSystem& system, double correlated) {
  const double scale = 1.0 / (static_cast<double>(ICP_UNIT_SIGMA_M) * ICP_UNIT_SIGMA_M * correlated);
  IcpSystem result = system;
  result.hessian *= scale;
  result.gradient *= scale;
  return result;
}

}  // namespace

IcpTracker::SystemPrior toSystem(const MotionPrior& prior, const Pose& T_M_W) {
  IcpTracker::SystemPrior result{orthonormalized(T_M_W * prior.T_W_D)};
  const Matrix6d to_system = adjoint(T_M_W);
  if (prior.covariance) {
    result.information = Matrix6d(to_system * *prior.covariance * to_system.transpose()).inverse();
    const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(*result.information, Eigen::EigenvaluesOnly);
    result.is_complete = solver.eigenvalues()(0) > kMoreThanAGuess * kGuessInformation;
  }
  if (prior.measured_pose) {
    const Matrix6d to_world = adjoint(T_M_W.inverse());
    result.measured_pose = PoseMeasurement{to_world.transpose() * prior.measured_pose->information * to_world,
                                           to_system * prior.measured_pose->error};
  }
  return result;
}

bool IcpTracker::SystemPrior::measures(const Vector6d& twist) const {
  double said = 0.0;
  if (information) said += twist.dot(*information * twist);
  if (measured_pose) said += twist.dot(measured_pose->information * twist);
  return said > kMoreThanAGuess * kGuessInformation * twist.squaredNorm();
}

int guessedDirections(const DegeneracyAnalysis& analysis, const IcpTracker::SystemPrior& prior) {
  const int free = analysis.freeDirections();
  if (free == 0 || prior.is_complete) return 0;
  if (!prior.information && !prior.measured_pose) return free;
  Matrix6d information = prior.information.value_or(Matrix6d::Zero());
  if (prior.measured_pose) information += prior.measured_pose->information;
  const Eigen::MatrixXd twists = analysis.freeTwists();
  const Eigen::MatrixXd said = twists.transpose() * information * twists;
  const Eigen::MatrixXd guessed = kGuessInformation * twists.transpose() * twists;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(said, guessed,
                                                                         Eigen::EigenvaluesOnly);
  return static_cast<int>((solver.eigenvalues().array() < kMoreThanAGuess).count());
}

IcpSolution solve(const DegeneracyAnalysis& analysis, const Pose& T_M_D, const IcpTracker::SystemPrior& prior,
                  double correlated) {
  const IcpSystem system = weighed(analysis.constrained(), correlated);
  const Vector6d deviation = twistFromPose(orthonormalized(T_M_D * prior.T_M_D.inverse()));
  // What nothing measures stays about where it was expected.
  const Matrix6d motion = prior.information.value_or(kGuessInformation * Matrix6d::Identity());
  Matrix6d other = motion;
  Vector6d gradient = system.gradient + motion * deviation;
  if (prior.measured_pose) {
    other += prior.measured_pose->information;
    gradient += prior.measured_pose->information * (deviation + prior.measured_pose->error);
  }
  const Matrix6d information = system.hessian + other, inverse = information.inverse();
  // The matches' own scatter says how sure they are, the weight how much they count.
  const double excess = analysis.system().correlated() / correlated;
  IcpSolution solution;
  solution.share_of_prior = inverse * motion;
  solution.covariance_of_prior = inverse * other * inverse;
  solution.covariance = inverse * (excess * system.hessian) * inverse + solution.covariance_of_prior;
  const bool is_measured = prior.information || prior.measured_pose;
  solution.twist = is_measured ? Vector6d(information.ldlt().solve(-gradient)) : analysis.solve(deviation);
  return solution;
}

double distanceFromPrior(const DegeneracyAnalysis& analysis, const Pose& T_M_D,
                         const IcpTracker::SystemPrior& prior, double correlated) {
  if (!prior.information || analysis.freeDirections() == 6) return 0.0;
  const Vector6d deviation = twistFromPose(orthonormalized(T_M_D * prior.T_M_D.inverse()));
  const Vector6d pull = *prior.information * deviation;
  const Matrix6d geometry = weighed(analysis.constrained(), correlated).hessian;
  const double squared =
      deviation.dot(pull) + pull.dot(geometry.completeOrthogonalDecomposition().solve(pull));
  return std::sqrt(std::max(squared, 0.0) / (6 - analysis.freeDirections()));
}

double weakestSaid(const IcpTracker::Alignment& alignment, const DepthFrame& frame) {
  const double of_all = informationAlong(alignment.weakest, frame.levels.back(), alignment.T_M_D);
  return of_all > 0.0 ? alignment.smallest_eigenvalue / of_all : 1.0;
}

std::string lostReason(const IcpTracker::Alignment& alignment, const IcpTracker::SystemPrior& prior,
                       const IcpTrackingParameters& parameters) {
  const IcpSystem& system = alignment.system;
  // The map of a few frames shows little of what is far; it is asked about what it does show.
  const double fraction = system.covered_points > 0.0 ? system.inliers / system.covered_points : 0.0;
  const Pose T_prior_D = prior.T_M_D.inverse() * alignment.T_M_D;
  std::ostringstream reason;
  if (system.source_points < 1.0) {
    reason << "no points with depth and normal";
  } else if (system.inliers < 6.0) {
    reason << "no point matches the view";
  } else if (system.source_points < parameters.min_inliers) {
    reason << "only " << system.source_points << " points with depth and normal";
  } else if (system.inliers < parameters.min_inliers || fraction < parameters.min_inlier_fraction) {
    reason << "only " << system.inliers << " inliers, " << std::lround(100.0 * fraction)
           << " % of the points that meet the map";
  } else if (!(system.rmse() <= parameters.max_rmse_m)) {
    reason << "rmse " << system.rmse() << " m";
  } else if (T_prior_D.translation().norm() > parameters.max_translation_m ||
             rotationAngle(T_prior_D) > parameters.max_rotation_rad) {
    reason << "jump of " << T_prior_D.translation().norm() << " m, " << rotationAngle(T_prior_D) << " rad";
  } else if (alignment.guessed > kMostFree) {
    reason << "the geometry seen leaves free " << alignment.free_directions << ", and nothing else helps";
  }
  return reason.str();
}

}  // namespace depth_fusion
