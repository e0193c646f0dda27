#include "depth_fusion/loops/loop_verifier.h"

#include <algorithm>
#include <cmath>

#include "loops/feature_alignment.h"
#include "loops/largest_sigma.h"
#include "loops/view_surface.h"

namespace depth_fusion {
namespace {

// Features are measured in two images of one moment each, whose depth and colour need not be of the same:
// their own covariance is too small by far.
constexpr double kFeatureDoubt = 9.0;

// Of the twist on the right: the new camera's own place and orientation, whatever the distance.
Matrix6d aboutNewCamera(const Pose& T_old_new, const Matrix6d& covariance) {
  const Matrix6d to_new = adjoint(T_old_new.inverse());
  return to_new * covariance * to_new.transpose();
}

}  // namespace

LoopVerifier::LoopVerifier(const LoopParameters& parameters) : parameters_(parameters) {
  validate(parameters_.table());
}

bool LoopVerifier::verify(const Keyframe& old_keyframe, const Keyframe& new_keyframe,
                          LoopCandidate& loop) const {
  loop.verdict = verdictOn(old_keyframe, new_keyframe, loop);
  return loop.verdict == LoopVerdict::kUnconfirmed;
}

LoopVerdict LoopVerifier::verdictOn(const Keyframe& old_keyframe, const Keyframe& new_keyframe,
                                    LoopCandidate& loop) const {
  if (old_keyframe.view.isEmpty() || new_keyframe.view.isEmpty()) return LoopVerdict::kNoView;
  const FeatureAlignment features = alignFeatures(old_keyframe.features, new_keyframe.features, parameters_);
  loop.matches = features.matches;
  loop.inliers = features.inliers;
  if (loop.matches < parameters_.min_inliers) return LoopVerdict::kFewMatches;
  if (!features.is_found) return LoopVerdict::kFewInliers;

  const ViewSurface old_view(old_keyframe.view, old_keyframe.features.depth_sensor);
  const ViewSurface new_view(new_keyframe.view, new_keyframe.features.depth_sensor);
  const ViewAlignment views =
      alignViews(old_view, new_view, features.T_old_new, kFeatureDoubt * features.covariance);
  if (!views.is_found) return LoopVerdict::kNoOverlap;
  loop.T_old_new = views.T_old_new;
  loop.overlap = views.overlap;
  loop.rmse_m = views.rmse_m;
  loop.rmse_sigmas = views.rmse_sigmas;
  const Pose disagreement = features.T_old_new.inverse() * views.T_old_new;
  loop.disagreement_m = disagreement.translation().norm();
  loop.disagreement_rad = rotationAngle(disagreement);
  loop.contradicted = contradictedShare(old_view, new_view, views.T_old_new);
  const Matrix6d about_new = aboutNewCamera(views.T_old_new, views.covariance);
  loop.sigma_rad = largestSigma(about_new.topLeftCorner<3, 3>());
  loop.sigma_m = largestSigma(about_new.bottomRightCorner<3, 3>());
  Vector6d more;
  more << Eigen::Vector3d::Constant(parameters_.loop_sigma_rad),
      Eigen::Vector3d::Constant(parameters_.loop_sigma_m);
  const Matrix6d to_old = adjoint(views.T_old_new);
  const Matrix6d floor = more.cwiseAbs2().asDiagonal();
  loop.covariance = views.covariance + to_old * floor * to_old.transpose();

  if (loop.disagreement_m > parameters_.max_disagreement_m ||
      loop.disagreement_rad > parameters_.max_disagreement_rad)
    return LoopVerdict::kDisagreement;
  if (loop.overlap < parameters_.min_overlap) return LoopVerdict::kNoOverlap;
  if (loop.rmse_sigmas > parameters_.max_rmse_sigmas) return LoopVerdict::kPoorFit;
  if (loop.contradicted > parameters_.max_contradicted) return LoopVerdict::kSeenThrough;
  if (loop.sigma_m > parameters_.max_sigma_m || loop.sigma_rad > parameters_.max_sigma_rad)
    return LoopVerdict::kWeak;
  return LoopVerdict::kUnconfirmed;
}

}  // namespace depth_fusion
