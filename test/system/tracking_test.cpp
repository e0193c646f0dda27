// Tracking that holds: on scenes that leave directions free, with fast hands, and through blackouts and
// jumps.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "depth_fusion/pipeline/reconstruction_pipeline.h"
#include "depth_fusion/recording/trajectory_file.h"
#include "depth_fusion/registration/registered_recording.h"
#include "support/real_data.h"
#include "support/test_compute.h"
#include "tools/evaluation/trajectory_error.h"
#include "tools/simulation/altered_recording.h"
#include "tools/simulation/simulated_recording.h"

namespace depth_fusion {
namespace {

struct Tracked {
  Trajectory trajectory;
  std::vector<size_t> lost;       // frames
  size_t updated_while_lost = 0;  // blocks
  TrajectoryError error;
  double path_m = 0.0;
};

double pathLength(const Trajectory& trajectory) {
  double length_m = 0.0;
  for (size_t i = 1; i < trajectory.size(); ++i) {
    length_m += (trajectory[i].T_W_D.translation() - trajectory[i - 1].T_W_D.translation()).norm();
  }
  return length_m;
}

Tracked track(Recording& recording, const Trajectory& truth, const PipelineParameters& parameters) {
  Tracked result;
  result.path_m = pathLength(truth);
  std::unique_ptr<ReconstructionPipeline> pipeline;
  for (size_t i = 0; const std::optional<RgbdFrame> frame = recording.next(); ++i) {
    if (!pipeline)
      pipeline = std::make_unique<ReconstructionPipeline>(compute(), parameters, frame->intrinsics);
    const FrameResult frame_result = pipeline->processFrame(*frame);
    if (frame_result.tracking.status == TrackingStatus::kLost) {
      result.lost.push_back(i);
      result.updated_while_lost += frame_result.fusion.blocks_updated;
    } else {
      result.trajectory.push_back({frame->stamp_s, frame_result.tracking.T_W_D});
    }
  }
  if (result.trajectory.size() > 3) result.error = compareTrajectories(result.trajectory, truth);
  std::printf("%s: %zu lost, ATE %.2f mm\n", recording.description().c_str(), result.lost.size(),
              1000.0 * result.error.ate_m.rmse);
  return result;
}

SimulationOptions sceneOptions(const std::string& scene, int frames) {
  SimulationOptions options;
  options.scene = scene;
  options.frames = frames;
  return options;
}

Tracked trackScene(const SimulationOptions& options, const PipelineParameters& parameters = {}) {
  SimulatedRecording recording(options);
  Trajectory truth;
  for (int i = 0; i < options.frames; ++i) truth.push_back(recording.poseOf(i));
  return track(recording, truth, parameters);
}

PipelineParameters icpAlone() {
  PipelineParameters parameters;
  parameters.texture_odometry.enabled = false;
  parameters.icp_tracking.degeneracy_threshold = 0.0f;
  return parameters;
}

// A third of the three metres that docs/benchmarks.md has, to be quick.
class FreeDirections : public testing::TestWithParam<const char*> {};

TEST_P(FreeDirections, come_from_texture) {
  const SimulationOptions options = sceneOptions(GetParam(), 100);
  const Tracked tracked = trackScene(options);
  EXPECT_TRUE(tracked.lost.empty());
  EXPECT_LE(tracked.error.ate_m.max, 0.005 * tracked.path_m);
}

INSTANTIATE_TEST_SUITE_P(Tracking, FreeDirections, testing::Values("wall", "floor_wall", "cylinder"));

TEST(Tracking, icp_alone_slips_along_a_wall) {
  const SimulationOptions options = sceneOptions("wall", 100);
  const Tracked tracked = trackScene(options, icpAlone());
  EXPECT_GE(tracked.error.ate_m.max, 0.1 * tracked.path_m)
      << "the control must fail, or the test shows nothing";
}

TEST(Tracking, a_room_without_texture_is_tracked_by_its_geometry) {
  const Tracked tracked = trackScene(sceneOptions("white_room", 100));
  EXPECT_TRUE(tracked.lost.empty());
  EXPECT_LE(tracked.error.ate_m.rmse, 0.010);
}

TEST(Tracking, fast_hands_are_followed) {
  SimulationOptions options = sceneOptions("room", 150);
  options.linear_speed_m_s = 0.5;
  options.turn_rate_deg_s = 60.0;
  const Tracked tracked = trackScene(options);
  EXPECT_TRUE(tracked.lost.empty());
  EXPECT_LE(tracked.error.ate_m.rmse, 0.015);
}

// The desk of the TUM benchmark with its camera's calibration, through a Kinect's rolling shutter.
class Desk : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(folder_)) GTEST_SKIP() << folder_ << " is not there";
    readCamera("cfg/cameras/tum_freiburg1.yaml", options_);
    loadParameterFile(parameters_.table(), "cfg/kinect_v1.yaml");
    truth_ = readPoses(folder_);
  }
  std::unique_ptr<Recording> open() { return registered(openFolder(folder_, options_), compute_, {}); }

  const std::string folder_ = realDataFolder("tum_fr1_xyz");
  ComputeContext compute_;
  RecordingOptions options_;
  PipelineParameters parameters_;
  Trajectory truth_;
};

TEST_F(Desk, is_followed_at_ten_hertz) {
  const Tracked tracked = track(*everyNth(open(), 3), truth_, parameters_);
  EXPECT_TRUE(tracked.lost.empty());
  EXPECT_LE(tracked.error.ate_m.rmse, 0.015);
}

TEST_F(Desk, is_found_again_after_a_blackout_and_a_jump) {
  const auto recording = interrupted([this] { return open(); }, {30, 100});
  const Tracked tracked = track(*recording, repeated(truth_), parameters_);
  ASSERT_GE(tracked.lost.size(), 30u);
  EXPECT_EQ(tracked.lost.front(), 500u);
  EXPECT_LT(tracked.lost.back(), 540u) << "back within 10 frames";
  EXPECT_EQ(tracked.updated_while_lost, 0u);
  EXPECT_LE(tracked.error.ate_m.rmse, 0.011);
}

// A recording from another frame on, its colour through JPEG.
class LaterAndCompressed : public Recording {
 public:
  LaterAndCompressed(std::unique_ptr<Recording> recording, size_t first, int jpeg_quality)
      : recording_(std::move(recording)), jpeg_quality_(jpeg_quality) {
    while (first-- > 0) recording_->next();
  }
  std::optional<RgbdFrame> next() override {
    std::optional<RgbdFrame> frame = recording_->next();
    if (!frame) return frame;
    std::vector<uchar> bytes;
    cv::imencode(".jpg", frame->color, bytes, {cv::IMWRITE_JPEG_QUALITY, jpeg_quality_});
    frame->color = cv::imdecode(bytes, cv::IMREAD_COLOR);
    return frame;
  }
  size_t frameCount() const override { return recording_->frameCount(); }
  std::string description() const override { return recording_->description(); }

 private:
  std::unique_ptr<Recording> recording_;
  const int jpeg_quality_;
};

struct OfficeStart {
  size_t first;
  bool texture;
  int jpeg_quality;
};

// A rendered office, whose ceiling has rows of lamps that are alike.
class Office : public testing::TestWithParam<OfficeStart> {};

INSTANTIATE_TEST_SUITE_P(Starts, Office,
                         testing::Values(OfficeStart{0, true, 95}, OfficeStart{0, true, 80},
                                         OfficeStart{0, true, 50}, OfficeStart{2, true, 95},
                                         OfficeStart{5, true, 80}, OfficeStart{8, true, 50},
                                         OfficeStart{3, false, 95}, OfficeStart{8, false, 95}));

TEST_P(Office, does_not_mislead) {
  const std::string folder = realDataFolder("icl_office_kt0");
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  RecordingOptions options;
  readCamera(folder + "/camera.yaml", options);
  PipelineParameters parameters;
  parameters.texture_odometry.enabled = GetParam().texture;
  LaterAndCompressed recording(openFolder(folder, options), GetParam().first, GetParam().jpeg_quality);
  const Tracked tracked = track(recording, readPoses(folder), parameters);
  EXPECT_TRUE(tracked.lost.empty());
  EXPECT_LE(tracked.error.ate_m.rmse, 0.0027);
}

}  // namespace
}  // namespace depth_fusion
