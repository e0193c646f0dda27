// What wheels, a gyroscope, gravity and a flat floor are good for, on simulated robots with exact poses.
#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "depth_fusion/geometry/angles.h"
#include "depth_fusion/pipeline/reconstruction_pipeline.h"
#include "support/room_frames.h"
#include "support/test_compute.h"

namespace depth_fusion {
namespace {

constexpr CameraIntrinsics kCamera{320, 240, 262.5, 262.5, 159.5, 119.5};

struct Ride {
  std::vector<TrackingResult> results;
  std::vector<Pose> truth;  // T_W_D, W as the first pose found has it
  int lost = 0;

  Pose errorAt(size_t i) const { return truth[i].inverse() * results[i].T_W_D; }
};

using Change = std::function<bool(int i, RgbdFrame& frame)>;  // false: the frame does not come

Ride track(
    const SimulationOptions& options, const PipelineParameters& parameters,
    const Change& change = [](int, RgbdFrame&) { return true; }) {
  SimulatedRecording recording(options);
  ReconstructionPipeline pipeline(compute(), parameters, options.intrinsics);
  Ride run;
  MotionReadings waiting;
  std::optional<Pose> T_W_world;
  for (int i = 0; auto frame = recording.next(); ++i) {
    waiting.T_B_D = frame->readings.T_B_D;
    for (const auto& reading : frame->readings.odometry) waiting.odometry.push_back(reading);
    for (const auto& reading : frame->readings.imu) waiting.imu.push_back(reading);
    if (!change(i, *frame)) continue;
    frame->readings = std::exchange(waiting, {});
    run.results.push_back(pipeline.processFrame(*frame).tracking);
    const TrackingResult& result = run.results.back();
    if (!T_W_world) T_W_world = result.T_W_D * frame->T_W_D->inverse();
    run.truth.push_back(*T_W_world * *frame->T_W_D);
    if (result.status == TrackingStatus::kLost) ++run.lost;
  }
  return run;
}

SimulationOptions simulation(const std::string& scene, int frames, double fps) {
  SimulationOptions options;
  options.scene = scene;
  options.frames = frames;
  options.fps = fps;
  options.intrinsics = kCamera;
  return options;
}

SimulationOptions robotInCorridor(int frames) {
  SimulationOptions options = simulation("white_corridor", frames, 7.5);
  options.walk = "drive";
  options.robot.has_wheels = true;
  return options;
}

// A window that holds all of the way.
PipelineParameters corridorParameters() {
  PipelineParameters parameters = coarseRoomParameters();
  parameters.map.blocks_per_axis = 192;
  parameters.map.pool_mib = 128;
  return parameters;
}

// The robot drives along x.
void expectInCorridor(const SimulationOptions& options) {
  const Ride run = track(options, corridorParameters());
  EXPECT_EQ(run.lost, 0);
  const Pose T_D_B = cameraOnRobot().inverse();
  const Pose begin = run.truth.front() * T_D_B, end = run.truth.back() * T_D_B;
  const Pose found = run.results.back().T_W_D * T_D_B;
  const Eigen::Vector3d way = begin.inverse() * end.translation();
  const Eigen::Vector3d error = begin.linear().transpose() * (found.translation() - end.translation());
  EXPECT_GT(way.x(), 7.0);
  EXPECT_LT(std::abs(error.x()), 0.025 * way.x());
  EXPECT_LT(std::abs(error.y()), 0.01);
}

TEST(RobotPriors, OdometryTellsTheWayAlongABareCorridor) { expectInCorridor(robotInCorridor(100)); }

TEST(RobotPriors, AlsoIfItIsLate) {
  SimulationOptions options = robotInCorridor(100);
  options.robot.wheel_delay_s = 0.15;
  expectInCorridor(options);
}

TEST(RobotPriors, AlsoIfItIsSlow) {
  SimulationOptions options = robotInCorridor(100);
  options.robot.wheel_rate_hz = 10.0;
  expectInCorridor(options);
}

TEST(RobotPriors, WheelsThatSlipAreFoundOut) {
  SimulationOptions options = simulation("white_room", 60, 10.0);
  options.robot.has_wheels = true;
  options.robot.slip_m = 0.5;
  const Ride run = track(options, coarseRoomParameters());
  int contradicted = 0;
  for (size_t i = 0; i < run.results.size(); ++i) {
    ASSERT_NE(run.results[i].status, TrackingStatus::kLost) << i << " " << run.results[i].reason;
    EXPECT_LT(run.errorAt(i).translation().norm(), 0.02) << i;
    for (const PriorDistance& prior : run.results[i].priors)
      if (prior.origin == "odometry" && prior.sigmas > 4.0) ++contradicted;
  }
  EXPECT_GE(contradicted, 3);
  EXPECT_LE(contradicted, 7) << "the wheels slip for half a second";
}

TEST(RobotPriors, AGyroscopeCarriesAFastTurnBeforeWhiteWalls) {
  SimulationOptions options = simulation("white_room", 40, 5.0);
  options.turn_rate_deg_s = 120.0;
  const Ride without = track(options, coarseRoomParameters());
  options.robot.has_imu = true;
  const Ride with = track(options, coarseRoomParameters());
  EXPECT_GT(without.lost, 0);
  EXPECT_EQ(with.lost, 0);
  EXPECT_LT(with.errorAt(with.results.size() - 1).translation().norm(), 0.05);
}

TEST(RobotPriors, AMapOfACameraWithAnAccelerometerIsLevel) {
  SimulationOptions options = simulation("room", 12, 15.0);
  options.robot.has_imu = true;
  options.robot.gyroscope_bias_rad_s = 0.0;
  const Ride run = track(options, coarseRoomParameters(), [](int i, RgbdFrame&) { return i > 4; });
  const Eigen::Vector3d up_W = run.results.front().T_W_D.linear() *
                               SimulatedRecording(options).poseOf(5).T_W_D.linear().transpose() *
                               Eigen::Vector3d::UnitZ();
  EXPECT_LT(std::acos(up_W.z()), 1.5 * kRadPerDeg);
  EXPECT_EQ(run.lost, 0);
}

TEST(RobotPriors, APlanarRobotKeepsItsHeightRollAndPitch) {
  SimulationOptions options = robotInCorridor(60);
  options.scene = "corridor";
  PipelineParameters parameters = corridorParameters();
  parameters.robot_motion.planar = true;
  const Ride run = track(options, parameters);
  EXPECT_EQ(run.lost, 0);
  for (const TrackingResult& result : run.results) {
    const Pose T_W_B = result.T_W_D * cameraOnRobot().inverse();
    EXPECT_LT(std::abs(T_W_B.translation().z()), 0.002);
    EXPECT_LT(std::acos(std::min(T_W_B.linear()(2, 2), 1.0)), 0.1 * kRadPerDeg);
  }
  EXPECT_LT(run.errorAt(59).translation().norm(), 0.1);
}

// From the 15th frame to the 30th the camera sees nothing, while it moves on.
TEST(RobotPriors, ABlindSensorGoesOnByOdometryAndIsBackAtOnce) {
  SimulationOptions options = simulation("white_room", 40, 10.0);
  options.robot.has_wheels = true;
  const Ride run = track(options, coarseRoomParameters(), [](int i, RgbdFrame& frame) {
    if (i >= 15 && i < 30) frame.depth = cv::Mat::zeros(frame.depth.size(), frame.depth.type());
    return true;
  });
  EXPECT_EQ(run.lost, 15);
  double before_m = 0.0;
  for (int i = 15; i < 30; ++i) {
    const TrackingResult& result = run.results[i];
    ASSERT_TRUE(result.bridged) << i;
    const Matrix6d to_sensor = adjoint(result.bridged->T_W_D.inverse());
    const Matrix6d covariance = to_sensor * *result.bridged->covariance * to_sensor.transpose();
    const double sigma_m = std::sqrt(covariance.diagonal().tail<3>().sum());
    EXPECT_GT(sigma_m, before_m);
    before_m = sigma_m;
    EXPECT_LT((run.truth[i].inverse() * result.bridged->T_W_D).translation().norm(), 3.0 * sigma_m);
  }
  for (size_t i = 30; i < run.results.size(); ++i) {
    EXPECT_NE(run.results[i].status, TrackingStatus::kLost) << i << " " << run.results[i].reason;
    EXPECT_LT(run.errorAt(i).translation().norm(), 0.03) << i;
  }
}

}  // namespace
}  // namespace depth_fusion
