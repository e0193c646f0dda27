// The sensor's motion as odometry: a pose that never jumps, and a velocity, each with its covariance.
#pragma once

#include <optional>

#include "depth_fusion/frames/tracking_result.h"

namespace depth_fusion {

// B is the body that the camera is mounted on, O the odometry's frame: where B was in the first frame.
struct OdometryState {
  Pose T_O_B = Pose::Identity();
  Matrix6d covariance = Matrix6d::Zero();  // of the twist applied to T_O_B on the left
  // The mean velocity since the tracked frame before (rotation, rad/s; translation, m/s), in B.
  Vector6d velocity = Vector6d::Zero();
  Matrix6d velocity_covariance = Matrix6d::Zero();
};

// Follows the poses of tracked frames. Where the map is corrected, or begins anew, the odometry goes on from
// where it was, and W is elsewhere in O.
class MapOdometry {
 public:
  // The state after the frame; none for the first one of a world, nor after a gap that says nothing of how
  // fast the sensor is now.
  std::optional<OdometryState> add(double stamp_s, const TrackingResult& tracked, const Pose& T_B_D);
  // The map has moved, and the last frame with it: by `correct`, from the pose that it had.
  template <class Correct>
  void moveWorld(const Correct& correct) {
    if (last_) place(correct(last_->pose));
  }
  // The frames to come are in another world: how the sensor moved since the last one is not known.
  void leaveWorld() { is_elsewhere_ = last_.has_value(); }

  Pose T_W_O() const { return T_W_O_; }

 private:
  struct Frame {
    StampedPose pose;  // T_W_D
    Pose T_B_D;
    Matrix6d covariance;  // of the frame alone, in W
  };
  // Puts the last frame there in W; it stays where it is in O.
  void place(const Pose& T_W_D);

  std::optional<Frame> last_;
  bool is_elsewhere_ = false;  // the next frame is in another world
  Pose T_W_O_ = Pose::Identity();
  Pose T_O_B_ = Pose::Identity();           // of the last frame
  Matrix6d covariance_ = Matrix6d::Zero();  // of the last frame, in O
  Matrix6d before_ = Matrix6d::Zero();      // the same, when W was last elsewhere
};

}  // namespace depth_fusion
