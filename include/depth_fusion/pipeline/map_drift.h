// How far off the parts of a map are from where it begins.
#pragma once

#include <vector>

#include "depth_fusion/geometry/pose.h"
#include "depth_fusion/pipeline/drift_parameters.h"

namespace depth_fusion {

// Drift is a random walk over new ground: each part of the map is anchored to the one from which the sensor
// came, and off by what that is, and a bit more. Where the sensor has been before, its pose is as sure as it
// was there for the first time, however long it has been going since. The ways are shortest ones among the
// anchors, as in an exploring tree.
class MapDrift {
 public:
  explicit MapDrift(const DriftParameters& parameters);

  void setParameters(const DriftParameters& parameters);
  // What each frame is off by beside noise, as a covariance of the twist on the left in W.
  Matrix6d ofFrame(const Pose& T_W_D) const;
  // The covariance, of the twist on the left in W, of the part of the map that is seen by a frame there,
  // whose own covariance is given; none for a map that is empty.
  Matrix6d at(const Pose& T_W_D, const Matrix6d& covariance = Matrix6d::Zero()) const;
  // Such a frame is fused; `carried` is what of its covariance it has from priors. True if that is in the
  // drift now, as the frame showed new ground.
  bool add(const Pose& T_W_D, const Matrix6d& covariance = Matrix6d::Zero(),
           const Matrix6d& carried = Matrix6d::Zero());
  // Begins anew with a map that was seen from these poses, in this order.
  void reset(const std::vector<Pose>& T_W_D = {});

 private:
  struct Anchor {
    Pose T_W_D = Pose::Identity();
    Matrix6d covariance = Matrix6d::Zero();
    double way = 0.0;  // to it, from the first one
  };
  // The map begins with the noise of its first frame, which is as large as that of the second.
  bool isSecond() const { return frames_ == 1; }
  size_t nearestTo(const Pose& T_W_D) const;
  // What the pose would be as an anchor.
  Anchor anchorAt(const Pose& T_W_D) const;
  Anchor beyond(const Anchor& from, const Pose& T_W_D) const;

  DriftParameters parameters_;
  std::vector<Anchor> anchors_;
  size_t frames_ = 0;
  size_t last_ = 0;  // the one that the last frame is nearest to
};

}  // namespace depth_fusion
