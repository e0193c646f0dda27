// What a simulated robot's sensors say, held against its exact path.
#include "tools/simulation/simulated_robot.h"

#include <gtest/gtest.h>

#include "tools/simulation/simulated_recording.h"

namespace depth_fusion {
namespace {

Pose straight(double time_s) {
  Pose pose = cameraOnRobot();
  pose.translation().x() += 0.5 * time_s;
  return pose;
}

double wayOf(const RobotOptions& options) {
  SimulatedRobot robot(options, straight, cameraOnRobot(), 1.0, 1);
  return robot.until(6.0).odometry.back().T_O_D.translation().x() - cameraOnRobot().translation().x();
}

TEST(SimulatedRobot, WheelsDriftAndSlipAsTheyAreTold) {
  RobotOptions options;
  options.has_wheels = true;
  options.wheel_heading_rad_m = 0.0;
  EXPECT_NEAR(wayOf(options), 3.0 * 1.02, 1e-6);
  options.slip_m = 0.5;
  EXPECT_NEAR(wayOf(options), 3.0 * 1.02 + 0.5, 1e-6);
  options.wheel_delay_s = 1.0;
  EXPECT_NEAR(wayOf(options), 2.5 * 1.02 + 0.5, 1e-6) << "the last second is still on its way";
}

TEST(SimulatedRobot, ADrivenCameraStaysUprightAtOneHeight) {
  SimulationOptions options;
  options.scene = "building";
  options.walk = "drive";
  options.fps = 1.0;
  const SimulatedRecording recording(options);
  for (int i = 0; i < 120; ++i) {
    const Pose T_W_B = recording.poseOf(i).T_W_D * cameraOnRobot().inverse();
    EXPECT_NEAR(T_W_B.translation().z(), 0.0, 1e-9);
    EXPECT_NEAR(T_W_B.linear()(2, 2), 1.0, 1e-9);
  }
}

}  // namespace
}  // namespace depth_fusion
