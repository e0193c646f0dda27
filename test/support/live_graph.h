// The nodelets that track and map, with a camera before them: a test sends frames and hears what they say of
// them.
#pragma once

#include <depth_fusion/SetMode.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <std_srvs/Trigger.h>

#include "support/nodelet_graph.h"

namespace depth_fusion {

// Expects that the sensor is where it is thought to be, to within a distance in metres and an angle in
// radians.
inline void expectPose(const Pose& found, const Pose& expected, double metres = 0.01,
                       double radians = 0.0087) {
  const Pose error = expected.inverse() * found;
  EXPECT_LT(error.translation().norm(), metres);
  EXPECT_LT(rotationAngle(error), radians);
}

class LiveGraph : public testing::Test {
 protected:
  LiveGraph()
      : graph_(std::string("live_") + testing::UnitTest::GetInstance()->current_test_info()->name()),
        camera_(graph_.handle()),
        map_status_(graph_.handle(), "tsdf_fusion/status"),
        tracker_status_(graph_.handle(), "icp_tracking/status"),
        poses_(graph_.handle(), "icp_tracking/pose") {}

  void loadTracking() {
    graph_.loadTracking();
    awaitTracking();
  }

  // Waits until all that frames pass is connected.
  void awaitTracking() {
    ASSERT_TRUE(camera_.awaitSubscribers());
    ASSERT_TRUE(map_status_.connected() && tracker_status_.connected());
  }

  // Publishes the frame, and returns what became of it, once it is known.
  MapStatus::ConstPtr fuse(const RgbdFrame& frame) {
    camera_.publish(frame);
    return map_status_.awaitStamp(camera_.headerOf(frame).stamp);
  }
  TrackerStatus::ConstPtr track(const RgbdFrame& frame) {
    camera_.publish(frame);
    return tracker_status_.awaitStamp(camera_.headerOf(frame).stamp);
  }
  void fuseAll(const std::vector<RgbdFrame>& frames) {
    for (const RgbdFrame& frame : frames) {
      const auto status = fuse(frame);
      ASSERT_NE(status, nullptr) << "no answer for " << frame.stamp_s;
      ASSERT_TRUE(status->fused) << status->reason;
    }
  }

  template <class Service>
  bool call(const std::string& name, typename Service::Request& request,
            typename Service::Response& response) {
    ros::ServiceClient client = graph_.handle().serviceClient<Service>(name);
    return client.waitForExistence(ros::Duration(kPatience_s)) && client.call(request, response);
  }
  // Returns once the map is empty.
  void resetVolume() {
    std_srvs::Trigger service;
    ASSERT_TRUE(call<std_srvs::Trigger>("tsdf_fusion/reset_volume", service.request, service.response));
    ASSERT_TRUE(service.response.success) << service.response.message;
  }
  void setMode(uint8_t mode) {
    SetMode service;
    service.request.mode = mode;
    ASSERT_TRUE(call<SetMode>("tsdf_fusion/set_mode", service.request, service.response));
    ASSERT_TRUE(service.response.success) << service.response.message;
  }

  NodeletGraph graph_;
  FakeCamera camera_;
  Listener<MapStatus> map_status_;
  Listener<TrackerStatus> tracker_status_;
  Listener<geometry_msgs::PoseWithCovarianceStamped> poses_;
};

}  // namespace depth_fusion
