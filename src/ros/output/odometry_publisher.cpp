#include "ros/output/odometry_publisher.h"

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <nav_msgs/Odometry.h>

#include <boost/make_shared.hpp>
#include <cstdint>

#include "ros/conversions/messages.h"

namespace depth_fusion {
namespace {

constexpr uint32_t kOdometryQueue = 10;

}  // namespace

OdometryPublisher::OdometryPublisher(ros::NodeHandle private_handle, const PoseParameters& parameters,
                                     TransformSender& transforms)
    : map_frame_(parameters.map_frame),
      visual_odom_frame_(parameters.visual_odom_frame),
      transforms_(transforms),
      odometry_publisher_(private_handle.advertise<nav_msgs::Odometry>("odometry", kOdometryQueue)),
      base_pose_publisher_(
          private_handle.advertise<geometry_msgs::PoseWithCovarianceStamped>("base_pose", kOdometryQueue)) {}

void OdometryPublisher::publish(const std_msgs::Header& camera, const TrackingResult& tracked) {
  const TransformSender::Body body = transforms_.bodyOf(camera.frame_id);
  auto pose = boost::make_shared<geometry_msgs::PoseWithCovarianceStamped>();
  pose->header = makeHeader(camera.stamp, map_frame_);
  pose->pose = toMessage(tracked.T_W_D * body.T_body_camera.inverse(), tracked.covariance + tracked.drift);
  base_pose_publisher_.publish(pose);

  const auto state = odometry_.add(camera.stamp.toSec(), tracked, body.T_body_camera);
  transforms_.sendLeaf(camera.stamp, visual_odom_frame_, odometry_.T_W_O());
  if (state) publishMotion(makeHeader(camera.stamp, body.frame), *state);
}

void OdometryPublisher::publishMotion(const std_msgs::Header& body, const OdometryState& state) {
  auto message = boost::make_shared<nav_msgs::Odometry>();
  message->header = makeHeader(body.stamp, visual_odom_frame_);
  message->child_frame_id = body.frame_id;
  message->pose = toMessage(state.T_O_B, state.covariance);
  message->twist = toMessage(state.velocity, state.velocity_covariance);
  odometry_publisher_.publish(message);
}

void OdometryPublisher::correct(const Corrections& corrections) {
  odometry_.moveWorld([&](const StampedPose& tracked) { return corrections.corrected(tracked); });
}

}  // namespace depth_fusion
