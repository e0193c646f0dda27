#include "ros/output/view_frame.h"

#include <cmath>

#include "ros/conversions/messages.h"

namespace depth_fusion {

void ViewFrame::follow(const ros::Time& stamp, const Pose& T_map_camera) {
  if (view_frame_.empty()) return;
  const Eigen::Vector3d axis = T_map_camera.linear().col(2);
  if (!yaw_rad_) yaw_rad_ = std::atan2(axis.y(), axis.x());
  Pose T_map_view = Pose::Identity();
  T_map_view.translation() = T_map_camera.translation();
  T_map_view.linear() = Eigen::AngleAxisd(*yaw_rad_, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  broadcaster_.sendTransform(makeTransform(makeHeader(stamp, map_frame_), view_frame_, T_map_view));
}

}  // namespace depth_fusion
