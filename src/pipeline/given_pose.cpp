#include "pipeline/given_pose.h"

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

}  // namespace depth_fusion
