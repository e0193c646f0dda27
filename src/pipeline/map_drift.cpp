#include "depth_fusion/pipeline/map_drift.h"

#include <algorithm>

namespace depth_fusion {
namespace {

constexpr double kApart = 0.1;  // from one anchor to the next: metres, and radians
constexpr double kReach = 0.5;  // within which views show the same surface
// A shorter way is taken if it saves so much; else the one over nearer anchors, which share more of the view.
constexpr double kFarther = 1.05;

// Metres and radians alike: at two metres, where surfaces are that rooms have, both move the view by as much.
double separation(const Pose& a, const Pose& b) {
  const double m = (a.translation() - b.translation()).norm();
  return m > kReach ? m : m + rotationAngle(a.inverse() * b);
}

// The same in all directions, about a point of W.
Matrix6d isotropic(double rad_squared, double m_squared, const Eigen::Vector3d& about_W) {
  Vector6d variances;
  variances << Eigen::Vector3d::Constant(rad_squared), Eigen::Vector3d::Constant(m_squared);
  const Matrix6d to_W = adjoint(Pose(Eigen::Translation3d(about_W)));
  return to_W * variances.asDiagonal() * to_W.transpose();
}

double squared(double value) { return value * value; }

}  // namespace

MapDrift::MapDrift(const DriftParameters& parameters) { setParameters(parameters); }

void MapDrift::setParameters(const DriftParameters& parameters) {
  validate(DriftParameters(parameters).table());
  parameters_ = parameters;
}

Matrix6d MapDrift::ofFrame(const Pose& T_W_D) const {
  return isotropic(squared(parameters_.frame_rad), squared(parameters_.frame_m), T_W_D.translation());
}

Matrix6d MapDrift::at(const Pose& T_W_D, const Matrix6d& covariance) const {
  if (anchors_.empty()) return Matrix6d::Zero();
  Vector6d scaled = Vector6d::Zero();
  scaled.tail<3>() = parameters_.scale * (T_W_D.translation() - anchors_.front().T_W_D.translation());
  const Matrix6d walked = anchorAt(T_W_D).covariance + scaled * scaled.transpose();
  return isSecond() ? Matrix6d(walked + covariance) : walked;
}

bool MapDrift::add(const Pose& T_W_D, const Matrix6d& covariance, const Matrix6d& carried) {
  if (isSecond()) anchors_.front().covariance += covariance;
  ++frames_;
  const size_t nearest = nearestTo(T_W_D);
  if (nearest < anchors_.size() && separation(anchors_[nearest].T_W_D, T_W_D) < kApart) {
    last_ = nearest;
    return false;
  }
  anchors_.push_back(anchors_.empty() ? Anchor{T_W_D} : anchorAt(T_W_D));
  anchors_.back().covariance += carried;
  last_ = anchors_.size() - 1;
  return true;
}

void MapDrift::reset(const std::vector<Pose>& T_W_D) {
  anchors_.clear();
  last_ = frames_ = 0;
  for (const Pose& pose : T_W_D) add(pose);
  // Where the last ones have come back to the first, the shortest way is from there.
  for (auto anchor = anchors_.rbegin(); anchor != anchors_.rend(); ++anchor)
    *anchor = anchorAt(anchor->T_W_D);
}

size_t MapDrift::nearestTo(const Pose& T_W_D) const {
  const auto farther = [&](const Anchor& a, const Anchor& b) {
    return separation(a.T_W_D, T_W_D) < separation(b.T_W_D, T_W_D);
  };
  return static_cast<size_t>(std::min_element(anchors_.begin(), anchors_.end(), farther) - anchors_.begin());
}

MapDrift::Anchor MapDrift::anchorAt(const Pose& T_W_D) const {
  const Anchor* best = nullptr;
  double shortest = 0.0;
  for (const Anchor& anchor : anchors_) {
    const double apart = separation(anchor.T_W_D, T_W_D), way = anchor.way + kFarther * apart;
    if (apart > kReach || (best != nullptr && way >= shortest)) continue;
    best = &anchor;
    shortest = way;
  }
  return beyond(best == nullptr ? anchors_[last_] : *best, T_W_D);
}

MapDrift::Anchor MapDrift::beyond(const Anchor& from, const Pose& T_W_D) const {
  const double m = (from.T_W_D.translation() - T_W_D.translation()).norm();
  const double rad = rotationAngle(from.T_W_D.inverse() * T_W_D);
  const auto variance = [&](double after_1m, double after_1rad) {
    return squared(after_1m) * m + squared(after_1rad) * rad;
  };
  const Matrix6d step =
      isotropic(variance(parameters_.rad_after_1m, parameters_.rad_after_1rad),
                variance(parameters_.m_after_1m, parameters_.m_after_1rad),
                0.5 * (from.T_W_D.translation() + T_W_D.translation()));  // a turn on the way has half of it
  return {T_W_D, from.covariance + step, from.way + m + rad};
}

}  // namespace depth_fusion
