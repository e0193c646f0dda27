#include "depth_fusion/icp_tracking/icp_tracker.h"

#include <cmath>

#include "icp_tracking/alignment.h"
#include "icp_tracking/frame_geometry.h"
#include "icp_tracking/icp_tracking_kernels.h"

namespace depth_fusion {
namespace {

// Where nothing else says anything, geometry has to say this part of the threshold at least.
constexpr double kWeakly = 0.5;
// The least part of what the frame's points would say of a motion that their matches have to say, for it to
// be measured by them.
constexpr double kSaid = 0.3;

// A step is of use as far as matches reach: no point at the box's border is to move farther than their gate.
Vector6d limited(const Vector6d& twist, const MatchGates& gates, const Eigen::AlignedBox3d& box) {
  const double reach_m = (twist.tail<3>() + twist.head<3>().cross(box.center())).norm() +
                         twist.head<3>().norm() * 0.5 * box.sizes().maxCoeff();
  return reach_m > gates.max_distance_m ? Vector6d(twist * (gates.max_distance_m / reach_m)) : twist;
}

}  // namespace

IcpTracker::IcpTracker(ComputeContext& compute, const IcpTrackingParameters& parameters,
                       const CameraIntrinsics& camera)
    : parameters_(parameters),
      partial_sums_(compute, camera.height * ICP_SUMS * sizeof(float), "ICP sums"),
      kernels_(std::make_unique<Kernels>(compute)) {
  validate(parameters_.table());
}

IcpTracker::~IcpTracker() = default;

void IcpTracker::setParameters(const IcpTrackingParameters& parameters) {
  validate(IcpTrackingParameters(parameters).table());
  parameters_ = parameters;
}

MatchGates IcpTracker::gatesAt(int level) const {
  const float coarseness = static_cast<float>(level) / (DepthFrame::kLevels - 1);
  const auto between = [&](float fine, float coarse) { return fine * std::pow(coarse / fine, coarseness); };
  return {between(parameters_.fine_distance_m, parameters_.coarse_distance_m),
          std::cos(between(parameters_.fine_normal_angle_rad, parameters_.coarse_normal_angle_rad)),
          parameters_.huber_sigmas, level == 0 ? parameters_.fine_row_step : 1};
}

bool IcpTracker::alignLevel(int level, const DepthFrame& frame, const ModelView& view,
                            const SystemPrior& prior, const Eigen::AlignedBox3d& box, Alignment& alignment) {
  // What geometry says weakly is worth more than no measurement. The structure tells what is free where
  // matches are right; where they are not yet, it is smaller.
  const double threshold = parameters_.degeneracy_threshold * (prior.is_complete ? 1.0 : kWeakly);
  const int iterations[] = {parameters_.fine_iterations, parameters_.middle_iterations,
                            parameters_.coarse_iterations};
  const MatchGates gates = gatesAt(level);
  const double coarseness = std::pow(4.0, level);  // the next level goes on from here
  for (int i = 0; i < iterations[level]; ++i) {
    alignment.system =
        kernels_->accumulateSystem(frame.levels[level], view, alignment.T_M_D, gates, partial_sums_);
    ++alignment.iterations;
    if (alignment.system.inliers < 6.0) return false;
    const IcpSystem& system = alignment.system;
    const DegeneracyAnalysis analysis(system, level == 0 ? system.structure : system.hessian, box, threshold);
    alignment.solution = solve(analysis, alignment.T_M_D, prior, parameters_.correlated_points);
    const Vector6d step = limited(alignment.solution.twist, gates, box);
    alignment.T_M_D = poseFromTwist(step) * alignment.T_M_D;
    const bool converged = step.head<3>().norm() < coarseness * parameters_.convergence_rad &&
                           step.tail<3>().norm() < coarseness * parameters_.convergence_m;
    if (!converged && i + 1 < iterations[level]) continue;
    alignment.free = analysis.freeDirections();
    alignment.guessed = guessedDirections(analysis, prior);
    alignment.free_directions = analysis.namesUpTo(parameters_.degeneracy_threshold);
    alignment.smallest_eigenvalue = analysis.smallestEigenvalue();
    alignment.weakest = analysis.weakestTwist();
    alignment.weakest_name = analysis.nameOf(0);
    alignment.prior_sigmas =
        distanceFromPrior(analysis, alignment.T_M_D, prior, parameters_.correlated_points);
    break;
  }
  return true;
}

Pose IcpTracker::bestStart(const DepthFrame& frame, const ModelView& view, const std::vector<Pose>& starts,
                           StageTimers& timers) {
  const StageTimers::Scope timer(timers, "icp_tracking/search");
  const int coarsest = static_cast<int>(frame.levels.size()) - 1;
  const Pose T_M_W = view.T_W_D.inverse();
  const Eigen::AlignedBox3d box = spreadBox(frame.levels.back(), T_M_W * starts.front());
  Pose best = starts.front();
  double most_explained = 0.0;
  for (const Pose& T_W_D : starts) {
    Alignment alignment;
    alignment.T_M_D = orthonormalized(T_M_W * T_W_D);
    alignLevel(coarsest, frame, view, {alignment.T_M_D}, box, alignment);
    if (alignment.system.fit <= most_explained) continue;
    most_explained = alignment.system.fit;
    best = orthonormalized(view.T_W_D * alignment.T_M_D);
  }
  return best;
}

TrackingResult IcpTracker::track(const DepthFrame& frame, const ModelView& view, const MotionPrior& prior,
                                 StageTimers& timers) {
  const StageTimers::Scope timer(timers, "icp_tracking");
  const SystemPrior system_prior = toSystem(prior, view.T_W_D.inverse());
  const Eigen::AlignedBox3d box = spreadBox(frame.levels.back(), system_prior.T_M_D);
  Alignment alignment;
  alignment.T_M_D = system_prior.T_M_D;
  bool matched = true;
  for (int level = static_cast<int>(frame.levels.size()) - 1; level >= 0 && matched; --level) {
    matched = alignLevel(level, frame, view, system_prior, box, alignment);
  }

  TrackingResult result;
  result.iterations = alignment.iterations;
  result.inliers = static_cast<int>(alignment.system.inliers);
  const double points = alignment.system.source_points;
  result.inlier_fraction = points > 0.0 ? alignment.system.inliers / points : 0.0;
  const double covered = alignment.system.covered_points;
  result.explained = covered > 0.0 ? alignment.system.fit / covered : 0.0;
  result.match_quality = result.inliers > 0 ? alignment.system.fit / alignment.system.inliers : 0.0;
  result.prior = prior.origin;
  result.prior_sigmas = alignment.prior_sigmas;
  result.rmse_m = alignment.system.rmse();
  result.smallest_eigenvalue = alignment.smallest_eigenvalue;
  result.T_W_D = orthonormalized(view.T_W_D * alignment.T_M_D);
  result.reason = lostReason(alignment, system_prior, parameters_);
  const bool is_found = result.reason.empty();
  if (is_found) {
    result.guessed_directions = alignment.guessed;
    result.reason = alignment.free_directions;
  }
  const bool may_slide = parameters_.degeneracy_threshold > 0.0f && alignment.free == 0 &&
                         !system_prior.is_complete && !system_prior.measures(alignment.weakest);
  if (is_found && may_slide) result.weakest_said = weakestSaid(alignment, frame);
  if (result.weakest_said < kSaid) {
    result.guessed_directions = 1;
    result.reason = alignment.weakest_name;
    const Vector6d direction = alignment.weakest.normalized();
    alignment.solution.covariance += direction * direction.transpose() / kGuessInformation;
  }
  const Matrix6d to_world = adjoint(view.T_W_D);
  const IcpSolution& solution = alignment.solution;
  result.covariance = to_world * solution.covariance * to_world.transpose();
  result.covariance_of_prior = to_world * solution.covariance_of_prior * to_world.transpose();
  result.share_of_prior = to_world * solution.share_of_prior * adjoint(view.T_W_D.inverse());
  if (is_found)
    result.status = result.reason.empty() ? TrackingStatus::kTracking : TrackingStatus::kDegenerate;
  return result;
}

}  // namespace depth_fusion
