// What a robot makes of our odometry and that of its wheels: an extended Kalman filter, as robot_localization
// is one, is better than either alone.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <random>

#include "depth_fusion/pipeline/map_odometry.h"
#include "depth_fusion/pipeline/reconstruction_pipeline.h"
#include "support/test_compute.h"
#include "tools/evaluation/consistency.h"
#include "tools/simulation/simulated_recording.h"

namespace depth_fusion {
namespace {

constexpr int kFrames = 50;
constexpr int kBlindFrom = 25, kBlindTo = 31;  // the camera sees nothing meanwhile
constexpr double kFps = 15.0;
constexpr double kScaleSigma = 0.05;  // of wheels: their radius, or the ground, is another one
constexpr double kNoise = 0.02;       // rad/s and m/s

// Pose and covariance, of the twist on the left.
class PoseFilter {
 public:
  void predict(const Vector6d& velocity, const Matrix6d& covariance, double seconds) {
    const Matrix6d to_O = seconds * adjoint(T_O_B_);
    covariance_ += to_O * covariance * to_O.transpose();
    T_O_B_ = orthonormalized(T_O_B_ * poseFromTwist(velocity * seconds));
  }
  void update(const Pose& T_O_B, const Matrix6d& covariance) {
    const Matrix6d gain = covariance_ * (covariance_ + covariance).inverse();
    T_O_B_ = orthonormalized(poseFromTwist(gain * twistFromPose(T_O_B * T_O_B_.inverse())) * T_O_B_);
    covariance_ -= gain * covariance_;
  }
  const Pose& pose() const { return T_O_B_; }

 private:
  Pose T_O_B_ = Pose::Identity();
  Matrix6d covariance_ = Matrix6d::Zero();
};

// A robot that measures its own motion by wheels that are off by a factor, with noise.
class Wheels {
 public:
  explicit Wheels(unsigned seed) : random_(seed) { factor_ = 1.0 + kScaleSigma * normal_(random_); }

  Vector6d measure(const Vector6d& velocity) {
    return factor_ * velocity + kNoise * Vector6d::NullaryExpr([&] { return normal_(random_); });
  }
  static Matrix6d covariance(const Vector6d& measured) {
    return kScaleSigma * kScaleSigma * measured * measured.transpose() +
           kNoise * kNoise * Matrix6d::Identity();
  }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  double factor_ = 1.0;
};

struct Errors {
  double camera = 0.0, wheels = 0.0, filter = 0.0;  // RMS of the position, metres
};

Errors drive(unsigned seed) {
  SimulationOptions options;
  options.frames = kFrames;
  options.fps = kFps;
  options.seed = seed;
  options.intrinsics = {160, 120, 131.25, 131.25, 79.5, 59.5};
  SimulatedRecording recording(options);
  PipelineParameters parameters;
  parameters.drift = driftOfNoise();
  ReconstructionPipeline pipeline(compute(), parameters, options.intrinsics);
  Wheels wheels(seed);
  MapOdometry odometry;
  PoseFilter filter, wheels_alone;
  Pose T_O_camera = Pose::Identity(), T_W_before = recording.poseOf(0).T_W_D;
  Errors squares;
  for (int i = 0; i < kFrames; ++i) {
    RgbdFrame frame = *recording.next();
    const Pose truth = recording.poseOf(0).T_W_D.inverse() * *frame.T_W_D;
    const Vector6d velocity = wheels.measure(kFps * twistFromPose(T_W_before.inverse() * *frame.T_W_D));
    T_W_before = *frame.T_W_D;
    for (PoseFilter* each : {&filter, &wheels_alone})
      each->predict(velocity, Wheels::covariance(velocity), 1.0 / kFps);
    if (i >= kBlindFrom && i < kBlindTo) frame.depth = cv::Mat::zeros(frame.depth.size(), CV_32FC1);
    const TrackingResult tracked = pipeline.processFrame(frame).tracking;
    if (tracked.status != TrackingStatus::kLost) {
      if (const auto state = odometry.add(frame.stamp_s, tracked, Pose::Identity())) {
        filter.update(state->T_O_B, state->covariance);
        T_O_camera = state->T_O_B;
      }
    }
    const auto add = [&](double& sum, const Pose& pose) {
      sum += (pose.translation() - truth.translation()).squaredNorm() / kFrames;
    };
    add(squares.camera, T_O_camera);
    add(squares.wheels, wheels_alone.pose());
    add(squares.filter, filter.pose());
  }
  return {std::sqrt(squares.camera), std::sqrt(squares.wheels), std::sqrt(squares.filter)};
}

TEST(FusedOdometry, IsBetterThanCameraAndWheels) {
  Errors squares;
  for (const unsigned seed : {1u, 2u, 3u}) {
    const Errors errors = drive(seed);
    std::printf("seed %u: camera %.1f mm, wheels %.1f mm, both %.1f mm\n", seed, 1e3 * errors.camera,
                1e3 * errors.wheels, 1e3 * errors.filter);
    squares.camera += errors.camera * errors.camera;
    squares.wheels += errors.wheels * errors.wheels;
    squares.filter += errors.filter * errors.filter;
  }
  EXPECT_LT(squares.filter, squares.camera);
  EXPECT_LT(squares.filter, squares.wheels);
}

}  // namespace
}  // namespace depth_fusion
