// What an alignment starts from and comes to, private to ICP tracking.
#pragma once

#include <optional>
#include <string>

#include "depth_fusion/icp_tracking/icp_tracker.h"
#include "icp_tracking/degeneracy.h"

namespace depth_fusion {

// A prior in the frame of the system, M.
struct IcpTracker::SystemPrior {
  Pose T_M_D;
  std::optional<Matrix6d> information = {};
  std::optional<PoseMeasurement> measured_pose = {};
  bool is_complete = false;  // it measures the motion in all directions

  // Whether it says more of the motion along the twist than a guess does.
  bool measures(const Vector6d& twist) const;
};

struct IcpSolution {
  Vector6d twist = Vector6d::Zero();
  // As TrackingResult has them.
  Matrix6d covariance = Matrix6d::Identity();
  Matrix6d covariance_of_prior = Matrix6d::Zero();
  Matrix6d share_of_prior = Matrix6d::Zero();
};

// The state that the iterations have come to.
struct IcpTracker::Alignment {
  Pose T_M_D;
  IcpSystem system;  // of the last iteration, as the members below
  IcpSolution solution;
  double prior_sigmas = 0.0;    // how far geometry alone is from the prior
  std::string free_directions;  // those that geometry says weakly among them
  int free = 0;                 // directions that geometry does not even say weakly
  int guessed = 0;              // of these, those that the prior does not measure, either
  double smallest_eigenvalue = 0.0;
  Vector6d weakest = Vector6d::Zero();  // twist of the smallest eigenvalue
  std::string weakest_name;
  int iterations = 0;
};

// What is guessed may be off by a third of a metre, or of a radian.
constexpr double kGuessInformation = 9.0;

// How much more than a guess a measurement says.
constexpr double kMoreThanAGuess = 2.0;

IcpTracker::SystemPrior toSystem(const MotionPrior& prior, const Pose& T_M_W);

// The step that balances matches and prior. Neighbouring matches share their errors, so that `correlated`
// count as one.
IcpSolution solve(const DegeneracyAnalysis& analysis, const Pose& T_M_D, const IcpTracker::SystemPrior& prior,
                  double correlated);
// How many of the free directions the prior does not measure.
int guessedDirections(const DegeneracyAnalysis& analysis, const IcpTracker::SystemPrior& prior);
// How far the solution of geometry alone is from the prior (TrackingResult::prior_sigmas), from the pose that
// balances both: the distances of that from either add up.
double distanceFromPrior(const DegeneracyAnalysis& analysis, const Pose& T_M_D,
                         const IcpTracker::SystemPrior& prior, double correlated);

// What the matches say along the weakest direction (TrackingResult::weakest_said). Where it is little, those
// points that would tell how far the frame is along it are the ones that do not match: its pose slides along
// that, as past lamps that are alike.
double weakestSaid(const IcpTracker::Alignment& alignment, const DepthFrame& frame);
// Why the alignment is not to be trusted, or nothing.
std::string lostReason(const IcpTracker::Alignment& alignment, const IcpTracker::SystemPrior& prior,
                       const IcpTrackingParameters& parameters);

}  // namespace depth_fusion
