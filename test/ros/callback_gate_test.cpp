// The gate waits for the callback at work, of a timer and of a service, and lets none begin afterwards.
#include "ros/callbacks/callback_gate.h"

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <std_srvs/Empty.h>

#include <atomic>

namespace depth_fusion {
namespace {

class CallbackGateTest : public testing::Test {
 protected:
  CallbackGateTest() : spinner_(3) { spinner_.start(); }

  void work() {
    ++begun_;
    if (begun_ == 1) first_.set_value();
    ros::WallDuration(0.3).sleep();
    ++done_;
  }

  // Closes the gate while a callback is at work.
  void closeDuringWork() {
    first_.get_future().wait();
    gate_.close();
    EXPECT_EQ(begun_, done_);
    const int begun = begun_;
    ros::WallDuration(0.3).sleep();
    EXPECT_EQ(begun_, begun);
  }

  ros::NodeHandle handle_;
  ros::AsyncSpinner spinner_;
  std::promise<void> first_;
  std::atomic<int> begun_{0}, done_{0};
  CallbackGate gate_;
};

TEST_F(CallbackGateTest, ItsEndWaitsForATimersCallback) {
  const ros::WallTimer timer =
      gate_.createWallTimer(handle_, ros::WallDuration(0.01), [this](const ros::WallTimerEvent&) { work(); });
  closeDuringWork();
}

TEST_F(CallbackGateTest, ItsEndWaitsForAServicesCallback) {
  const ros::ServiceServer server =
      gate_.advertiseService<std_srvs::Empty::Request, std_srvs::Empty::Response>(handle_, "work",
                                                                                  [this](auto&, auto&) {
                                                                                    work();
                                                                                    return true;
                                                                                  });
  const auto call = [] {
    std_srvs::Empty empty;
    return ros::service::call("work", empty);
  };
  const auto first = std::async(std::launch::async, call);
  closeDuringWork();
  EXPECT_FALSE(call());
}

}  // namespace
}  // namespace depth_fusion
