// Poses and velocities are as far off as their covariances say. benchmark covariance has more and longer
// runs.
#include <gtest/gtest.h>

#include "depth_fusion/pipeline/map_odometry.h"
#include "depth_fusion/pipeline/reconstruction_pipeline.h"
#include "support/test_compute.h"
#include "tools/evaluation/consistency.h"
#include "tools/simulation/simulated_recording.h"

namespace depth_fusion {
namespace {

constexpr int kRuns = 5, kFrames = 25;

struct MeanNees {
  double last_pose = 0.0, velocities = 0.0;
};

MeanNees followRoom(const DriftParameters& drift) {
  MeanNees mean;
  for (unsigned seed = 1; seed <= kRuns; ++seed) {
    SimulationOptions options;
    options.frames = kFrames;
    options.fps = 10.0;
    options.seed = seed;
    options.intrinsics = halved(makeScene("room").sensor.camera);
    SimulatedRecording recording(options);
    PipelineParameters parameters;
    parameters.drift = drift;
    ReconstructionPipeline pipeline(compute(), parameters, options.intrinsics);
    MapOdometry odometry, true_odometry;
    for (int i = 0; i < kFrames; ++i) {
      const RgbdFrame frame = *recording.next();
      const TrackingResult tracked = pipeline.processFrame(frame).tracking;
      EXPECT_EQ(tracked.status, TrackingStatus::kTracking) << tracked.reason;
      TrackingResult truth;
      truth.T_W_D = recording.poseOf(0).T_W_D.inverse() * *frame.T_W_D;
      const auto state = odometry.add(frame.stamp_s, tracked, Pose::Identity());
      const auto true_state = true_odometry.add(frame.stamp_s, truth, Pose::Identity());
      if (state && true_state)
        mean.velocities += nees(state->velocity - true_state->velocity, state->velocity_covariance) /
                           (kRuns * (kFrames - 1));
      if (i + 1 == kFrames)
        mean.last_pose +=
            nees(twistFromPose(tracked.T_W_D * truth.T_W_D.inverse()), tracked.covariance + tracked.drift) /
            kRuns;
    }
  }
  return mean;
}

TEST(Covariance, IsThatOfTheErrors) {
  const MeanNees mean = followRoom(driftOfNoise());
  const NeesBounds bounds = neesBounds(kRuns);
  EXPECT_TRUE(bounds.hold(mean.last_pose)) << mean.last_pose;
  EXPECT_TRUE(bounds.hold(mean.velocities)) << mean.velocities;
}

}  // namespace
}  // namespace depth_fusion
