// What defeats other trackers: no frame that is called tracking may be wrong by 5 cm or 3 degrees, frames are
// lost only where the input says nothing, and the sensor is found again after.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "depth_fusion/geometry/angles.h"
#include "depth_fusion/pipeline/reconstruction_pipeline.h"
#include "support/synthetic_fusion.h"
#include "support/test_compute.h"
#include "tools/evaluation/trajectory_error.h"
#include "tools/simulation/altered_recording.h"
#include "tools/simulation/simulated_recording.h"

namespace depth_fusion {
namespace {

constexpr double kWrong_m = 0.05;
constexpr double kWrong_deg = 3.0;

struct Outcome {
  size_t frames = 0;
  std::vector<size_t> lost, degenerate;
  std::vector<size_t> wrong;                  // called tracking
  double largest_m = 0.0, largest_deg = 0.0;  // of those called tracking
  double largest_guessed_m = 0.0;             // of those called degenerate
  std::vector<double> error_m;                // of each frame that is not lost
  std::string first_reason;                   // to be lost
  std::string map_doubt;
  size_t doubted_at = 0;  // frame

  // How many of the frames [begin, end) are lost.
  size_t lostAmong(size_t begin, size_t end) const {
    return std::count_if(lost.begin(), lost.end(), [=](size_t i) { return i >= begin && i < end; });
  }
};

void print(const char* what, const std::vector<size_t>& frames) {
  std::printf(", %zu %s", frames.size(), what);
  for (size_t i = 0; i < frames.size(); ++i) {
    const bool first = i == 0 || frames[i - 1] + 1 != frames[i];
    const bool last = i + 1 == frames.size() || frames[i] + 1 != frames[i + 1];
    if (first) std::printf(" %zu", frames[i]);
    if (last && !first) std::printf("-%zu", frames[i]);
  }
}

// Tracks a recording with exact poses. A pose is as wrong as the motion since the map's first one.
Outcome track(Recording& recording, const PipelineParameters& parameters = {}) {
  Outcome outcome;
  std::unique_ptr<ReconstructionPipeline> pipeline;
  std::optional<PosePair> first;
  while (const std::optional<RgbdFrame> frame = recording.next()) {
    if (!pipeline) {
      pipeline = std::make_unique<ReconstructionPipeline>(compute(), parameters, frame->intrinsics);
    }
    const TrackingResult tracking = pipeline->processFrame(*frame).tracking;
    const size_t i = outcome.frames++;
    if (outcome.map_doubt.empty() && !tracking.map_doubt.empty()) outcome.doubted_at = i;
    outcome.map_doubt = tracking.map_doubt;
    if (tracking.status == TrackingStatus::kLost) {
      if (outcome.lost.empty()) outcome.first_reason = tracking.reason;
      outcome.lost.push_back(i);
      continue;
    }
    const PosePair pair{frame->stamp_s, tracking.T_W_D, *frame->T_W_D};
    if (!first || tracking.prior == "start") first = pair;
    const Pose error = motionError(*first, pair);
    const double error_m = error.translation().norm(), error_deg = rotationAngle(error) * kDegPerRad;
    outcome.error_m.push_back(error_m);
    if (tracking.status == TrackingStatus::kDegenerate) {
      outcome.degenerate.push_back(i);
      outcome.largest_guessed_m = std::max(outcome.largest_guessed_m, error_m);
      continue;
    }
    if (error_m > kWrong_m || error_deg > kWrong_deg) outcome.wrong.push_back(i);
    outcome.largest_m = std::max(outcome.largest_m, error_m);
    outcome.largest_deg = std::max(outcome.largest_deg, error_deg);
  }
  std::printf("%s: %.1f mm, %.2f deg at most", recording.description().c_str(), 1e3 * outcome.largest_m,
              outcome.largest_deg);
  for (size_t i = 19; i < outcome.error_m.size(); i += 20) std::printf(" %.1f", 1e3 * outcome.error_m[i]);
  print("wrong", outcome.wrong);
  print("lost", outcome.lost);
  print("degenerate", outcome.degenerate);
  std::printf(" %s; %s\n", outcome.first_reason.c_str(), outcome.map_doubt.c_str());
  return outcome;
}

// No frame is lost, none that is called tracking is wrong, and nothing speaks against the map.
void expectFollowed(const Outcome& outcome) {
  EXPECT_EQ(outcome.map_doubt, "");
  EXPECT_TRUE(outcome.wrong.empty());
  EXPECT_TRUE(outcome.lost.empty());
}

SimulationOptions scene(const std::string& name, int frames) {
  SimulationOptions options;
  options.scene = name;
  options.frames = frames;
  options.intrinsics = halved(makeScene(name).sensor.camera);
  return options;
}

// What cfg/kinect_v1.yaml says of the shutter.
PipelineParameters rollingShutter() {
  PipelineParameters parameters;
  parameters.preprocessing.readout_s = 0.03f;
  return parameters;
}

Outcome trackScene(const SimulationOptions& options, const PipelineParameters& parameters = {}) {
  SimulatedRecording recording(options);
  return track(recording, parameters);
}

TEST(DefeatsOthers, LampsShelvesAndTilesThatAreAlike) {
  const Outcome outcome = trackScene(scene("alike", 100));
  expectFollowed(outcome);
}

// What tells one lamp from the next are few points far away: the sensor is soon lost, and is not found again
// beside the wrong lamp.
TEST(DefeatsOthers, LampsThatAreAlikeWithoutTextureAreNotMistaken) {
  PipelineParameters parameters;
  parameters.texture_odometry.enabled = false;
  const Outcome outcome = trackScene(scene("alike", 60), parameters);
  EXPECT_TRUE(outcome.wrong.empty());
}

TEST(DefeatsOthers, SomebodyWhoFillsTheView) {
  const Outcome outcome = trackScene(scene("person", 140));
  EXPECT_TRUE(outcome.wrong.empty());
  EXPECT_EQ(outcome.lostAmong(0, 30), 0u);
  EXPECT_EQ(outcome.lostAmong(130, 140), 0u);
}

TEST(DefeatsOthers, AHandOverTheLens) {
  const Outcome outcome = trackScene(scene("hand", 90));
  EXPECT_TRUE(outcome.wrong.empty());
  EXPECT_EQ(outcome.lostAmong(0, 30), 0u);
  EXPECT_EQ(outcome.lostAmong(60, 90), 0u);
}

// Until the hand is gone the sensor has turned by 25 degrees, and texture does not find it.
TEST(DefeatsOthers, AHandOverTheLensOfASensorThatTurns) {
  SimulationOptions options = scene("hand", 60);
  options.seed = 3;
  const Outcome outcome = trackScene(options);
  EXPECT_TRUE(outcome.wrong.empty());
  EXPECT_EQ(outcome.lostAmong(0, 30), 0u);
  EXPECT_EQ(outcome.lostAmong(56, 60), 0u);
}

// After that person the view is mostly of what the map does not have yet.
TEST(DefeatsOthers, SomebodyWhoLeavesAnotherView) {
  SimulationOptions options = scene("person", 140);
  options.seed = 3;
  const Outcome outcome = trackScene(options);
  EXPECT_TRUE(outcome.wrong.empty());
  EXPECT_EQ(outcome.lostAmong(0, 30), 0u);
  EXPECT_EQ(outcome.lostAmong(130, 140), 0u);
}

// The pose is guessed along a bare corridor, but not for long; further on, places look alike.
TEST(DefeatsOthers, ABareCorridor) {
  SimulationOptions options = scene("white_corridor", 150);
  options.fps = 15.0;
  const Outcome outcome = trackScene(options);
  EXPECT_TRUE(outcome.wrong.empty());
  // What is measured has drifted by then, which a guess goes on with.
  EXPECT_LT(outcome.largest_guessed_m, outcome.largest_m + 0.03);
  EXPECT_LE(outcome.lostAmong(3, 60), 2u);
  EXPECT_EQ(outcome.lostAmong(70, 150), 80u);
}

TEST(DefeatsOthers, ThingsThatTurnOnATable) {
  const Outcome outcome = trackScene(scene("turntable", 80));
  expectFollowed(outcome);
}

// The pose is drawn along with them, and the map along with the pose. What was seen before tells.
TEST(DefeatsOthers, ThingsThatTurnForLongAreNoticedBeforePosesAreWrong) {
  const Outcome outcome = trackScene(scene("turntable", 150));
  EXPECT_NE(outcome.map_doubt.find("as it was seen before"), std::string::npos) << outcome.map_doubt;
  EXPECT_TRUE(outcome.wrong.empty() || outcome.doubted_at < outcome.wrong.front()) << outcome.doubted_at;
}

TEST(DefeatsOthers, AMirror) {
  const Outcome outcome = trackScene(scene("mirror", 110));
  expectFollowed(outcome);
}

TEST(DefeatsOthers, AGlassWall) {
  const Outcome outcome = trackScene(scene("glass", 80));
  expectFollowed(outcome);
}

TEST(DefeatsOthers, LightSwitchedOff) {
  SimulationOptions options = scene("room", 90);
  options.lifelike = true;
  const auto recording = lightsOff(std::make_unique<SimulatedRecording>(options), 30, 30);
  const Outcome outcome = track(*recording, rollingShutter());
  expectFollowed(outcome);
}

// A first frame that has depth in a few pixels only makes a map that nothing fits (docs/tracking.md).
TEST(DefeatsOthers, AStartTooNearAWallIsNotWrong) {
  const Outcome outcome = trackScene(scene("backing", 40));
  EXPECT_TRUE(outcome.wrong.empty());
}

TEST(DefeatsOthers, AStartBeforeAWall) {
  SimulatedRecording recording(scene("backing", 120));
  for (int i = 0; i < 15; ++i) recording.next();  // until it is in range
  const Outcome outcome = track(recording);
  expectFollowed(outcome);
}

TEST(DefeatsOthers, FastShakes) {
  const Outcome outcome = trackScene(scene("shaken", 120), rollingShutter());
  expectFollowed(outcome);
}

// The mean distance of the surface after so many frames from one place.
double surfaceAfter(int frames) {
  SimulationOptions options = scene("room", frames);
  options.speed = 1e-6;
  options.tremor = 0.0;
  options.lifelike = true;
  SimulatedRecording recording(options);
  const Reconstruction result = reconstruct(compute(), recording, rollingShutter(), Poses::kTracked);
  EXPECT_EQ(result.lost, 0u);
  double creep_m = 0.0;
  for (const StampedPose& pose : result.estimate) {
    creep_m = std::max(creep_m, pose.T_W_D.translation().norm());
  }
  const MeshError error = compareMesh(result.mesh, result.T_W_M, recording.scene().surface);
  std::printf(
      "%d frames standing still: %.1f mm from the first pose at most, surface %.2f mm off, 95 %% %.1f mm\n",
      frames, 1e3 * creep_m, 1e3 * error.surface_m.mean, 1e3 * error.surface_m.percentile95);
  EXPECT_LT(creep_m, 0.003);
  return error.surface_m.mean;
}

TEST(DefeatsOthers, StandingStill) {
  const double early_m = surfaceAfter(40);
  EXPECT_LT(surfaceAfter(200), 1.05 * early_m) << "ghosts";
}

TEST(DefeatsOthers, IrregularFrames) {
  SimulationOptions options = scene("room", 180);
  options.lifelike = true;
  const auto recording = irregular(std::make_unique<SimulatedRecording>(options), 6, 1);
  const Outcome outcome = track(*recording, rollingShutter());
  expectFollowed(outcome);
}

TEST(DefeatsOthers, TenHertz) {
  SimulationOptions options = scene("room", 45);
  options.lifelike = true;
  options.fps = 10.0;
  const Outcome outcome = trackScene(options, rollingShutter());
  expectFollowed(outcome);
}

TEST(DefeatsOthers, LargeImages) {
  SimulationOptions options = scene("room", 10);
  options.lifelike = true;
  options.fps = 15.0;
  options.intrinsics = {1280, 720, 920.0, 920.0, 639.5, 359.5};
  const Outcome outcome = trackScene(options, rollingShutter());
  expectFollowed(outcome);
}

}  // namespace
}  // namespace depth_fusion
