// A sensor that is lost for long goes on in another part of the map, until a loop joins the two.
#include <gtest/gtest.h>

#include "depth_fusion/pipeline/reconstruction_pipeline.h"
#include "support/room_frames.h"
#include "support/test_compute.h"

namespace depth_fusion {
namespace {

constexpr CameraIntrinsics kCamera{320, 240, 262.5, 262.5, 159.5, 119.5};
constexpr int kFirstPart = 45, kFarthest = 200;  // frames; the camera turns by half a degree and more in each
constexpr double kLost_s = 0.5;

PipelineParameters partParameters() {
  PipelineParameters parameters = coarseRoomParameters();
  parameters.relocalisation.lost_s = static_cast<float>(kLost_s);
  return parameters;
}

// A part of a room, then, without a way there, another one, from where the camera goes back to the first.
std::vector<RgbdFrame> thereByAJumpAndBack() {
  SimulationOptions options;
  options.scene = "large_room";
  options.frames = kFarthest;
  options.intrinsics = kCamera;
  std::vector<RgbdFrame> all, frames;
  SimulatedRecording recording(options);
  while (std::optional<RgbdFrame> frame = recording.next()) all.push_back(std::move(*frame));
  frames.assign(all.begin(), all.begin() + kFirstPart);
  frames.insert(frames.end(), all.rbegin(), all.rend());
  for (size_t i = 0; i < frames.size(); ++i) frames[i].stamp_s = 1.0 + static_cast<double>(i) / options.fps;
  return frames;
}

const std::vector<RgbdFrame>& frames() {
  static const std::vector<RgbdFrame> frames = thereByAJumpAndBack();
  return frames;
}

// How far the pose is off, in W of the first frame.
double error_m(const RgbdFrame& frame, const Pose& T_W_D) {
  const Pose truth = frames().front().T_W_D->inverse() * *frame.T_W_D;
  return (truth.translation() - T_W_D.translation()).norm();
}

TEST(MapParts, ALoopJoinsWhatALostSensorMapped) {
  ReconstructionPipeline pipeline(compute(), partParameters(), kCamera);
  pipeline.closeLoops();
  std::vector<std::pair<const RgbdFrame*, FrameResult>> tracked;
  int lost = 0, begun = 0;
  for (const RgbdFrame& frame : frames()) {
    const FrameResult result = pipeline.processFrame(frame);
    if (result.tracking.status == TrackingStatus::kLost) {
      ++lost;
      continue;
    }
    const bool begins = result.tracking.prior == "part start";
    begun += begins;
    EXPECT_EQ(result.tracking.map_doubt.empty(), begun == 0) << result.tracking.map_doubt;
    if (begins) {
      EXPECT_EQ(result.tracking.status, TrackingStatus::kDegenerate);
      EXPECT_NE(result.tracking.reason.find("another part of the map begins"), std::string::npos);
      EXPECT_NE(result.tracking.map_doubt.find("until a loop joins it"), std::string::npos);
      EXPECT_EQ(lost, cvRound(30.0 * kLost_s) + 1);
      EXPECT_GT(error_m(frame, result.tracking.T_W_D), 0.5) << "it is far from where it is expected";
    }
    tracked.emplace_back(&frame, result);
  }
  EXPECT_EQ(begun, 1);
  EXPECT_EQ(pipeline.submaps().submaps().size(), 2u);
  pipeline.loops()->finish();
  EXPECT_TRUE(pipeline.loops()->joinsParts());
  const Corrections corrections = pipeline.loops()->corrections();
  EXPECT_FALSE(corrections.isApart());
  for (const auto& [frame, result] : tracked) {
    const Pose corrected = corrections.corrected({frame->stamp_s, result.tracking.T_W_D});
    ASSERT_LT(error_m(*frame, corrected), 0.06) << frame->stamp_s;
  }
}

// Until a loop joins the parts, keyframes say that nothing does.
TEST(MapParts, WithoutALoopThePartsStayApart) {
  ReconstructionPipeline pipeline(compute(), partParameters(), kCamera);
  pipeline.closeLoops();
  for (int i = 0; i < kFirstPart + 40; ++i) pipeline.processFrame(frames()[i]);
  pipeline.loops()->finish();
  EXPECT_FALSE(pipeline.loops()->joinsParts());
  const Corrections keyframes = pipeline.loops()->keyframes();
  EXPECT_TRUE(keyframes.isApart());
  EXPECT_NE(keyframes.partAt(frames().front().stamp_s), keyframes.partAt(frames()[kFirstPart + 39].stamp_s));
}

// No loop joins what shows no features, or where none are sought: the sensor is searched for.
TEST(MapParts, ASensorThatNoLoopCouldJoinStaysLost) {
  for (const bool with_texture : {false, true}) {
    ReconstructionPipeline pipeline(compute(), partParameters(), kCamera);
    if (!with_texture) pipeline.closeLoops();
    for (int i = 0; i < kFirstPart + 40; ++i) {
      RgbdFrame frame = frames()[i];
      if (!with_texture) frame.color.release();
      const bool is_lost = pipeline.processFrame(frame).tracking.status == TrackingStatus::kLost;
      EXPECT_TRUE(is_lost || i < kFirstPart) << i;
    }
    EXPECT_EQ(pipeline.submaps().submaps().size(), 1u);
  }
}

TEST(MapParts, NoneBeginsWhereLostForEverIsWanted) {
  PipelineParameters parameters = partParameters();
  parameters.relocalisation.lost_s = 0.0f;
  ReconstructionPipeline pipeline(compute(), parameters, kCamera);
  pipeline.closeLoops();
  for (int i = 0; i < kFirstPart + 40; ++i) pipeline.processFrame(frames()[i]);
  EXPECT_EQ(pipeline.submaps().submaps().size(), 1u);
}

}  // namespace
}  // namespace depth_fusion
