// A simulated robot's bag: what its sensors said is read as it was.
#include <gtest/gtest.h>

#include "ros/bags/open_recording.h"
#include "ros/conversions/imu_conversion.h"
#include "support/temporary_folder.h"
#include "tools/simulation/simulated_recording.h"

namespace depth_fusion {
namespace {

constexpr int kFrames = 6;

SimulationOptions robotInRoom() {
  SimulationOptions options;
  options.scene = "white_corridor";
  options.walk = "drive";
  options.frames = kFrames;
  options.fps = 10.0;
  options.intrinsics = {64, 48, 52.5, 52.5, 31.5, 23.5};
  options.robot.has_wheels = options.robot.has_imu = true;
  return options;
}

TEST(BagRobot, GivesWhatTheRobotSaid) {
  const TemporaryFolder folder;
  const std::string path = folder / "robot.bag";
  const auto writer = createBag(path);
  SimulatedRecording recording(robotInRoom());
  std::vector<RgbdFrame> written;
  while (auto frame = recording.next()) {
    frame->depth.convertTo(frame->depth, CV_16UC1, 1000.0);
    frame->depth_unit_m = 0.001;
    written.push_back(*frame);
    writer->write(*frame);
  }
  writer->finish();

  const auto bag = openRecording(path, {});
  EXPECT_NE(bag->description().find("odometry in odom, inertial sensor /imu/data"), std::string::npos)
      << bag->description();
  for (const RgbdFrame& sent : written) {
    const auto read = bag->next();
    ASSERT_TRUE(read);
    EXPECT_TRUE(read->readings.T_B_D->isApprox(cameraOnRobot(), 1e-6));
    ASSERT_EQ(read->readings.odometry.size(), 1u);
    EXPECT_TRUE(read->readings.odometry[0].T_O_D.isApprox(sent.readings.odometry.back().T_O_D, 1e-6));
    ASSERT_EQ(read->readings.imu.size(), sent.readings.imu.size());
    for (size_t i = 0; i < sent.readings.imu.size(); ++i) {
      const ImuReading &a = read->readings.imu[i], &b = sent.readings.imu[i];
      EXPECT_NEAR(a.stamp_s, b.stamp_s, 1e-6);
      EXPECT_TRUE(a.angular_velocity_D->isApprox(*b.angular_velocity_D, 1e-6));
      EXPECT_TRUE(a.specific_force_D->isApprox(*b.specific_force_D, 1e-6));
    }
  }
}

TEST(ImuConversion, WhatIsNotMeasuredIsLeftOut) {
  sensor_msgs::Imu message;
  message.angular_velocity.x = 0.5;
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(M_PI / 2.0, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  ImuReading reading = toReading(message, turn);
  EXPECT_TRUE(reading.angular_velocity_D->isApprox(Eigen::Vector3d(0.0, 0.5, 0.0)));
  EXPECT_FALSE(reading.specific_force_D) << "a gyroscope alone sends a force of zero";
  message.angular_velocity_covariance[0] = -1.0;
  message.linear_acceleration.z = 9.81;
  reading = toReading(message, turn);
  EXPECT_FALSE(reading.angular_velocity_D);
  EXPECT_TRUE(reading.specific_force_D);
}

}  // namespace
}  // namespace depth_fusion
