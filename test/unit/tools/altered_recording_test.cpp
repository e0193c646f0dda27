#include "tools/simulation/altered_recording.h"

#include <gtest/gtest.h>

#include "tools/simulation/simulated_recording.h"

namespace depth_fusion {
namespace {

std::unique_ptr<Recording> room() {
  SimulationOptions options;
  options.frames = 7;
  options.intrinsics = {40, 30, 32.8, 32.8, 19.5, 14.5};
  return std::make_unique<SimulatedRecording>(options);
}

std::vector<RgbdFrame> framesOf(Recording& recording) {
  std::vector<RgbdFrame> frames;
  while (std::optional<RgbdFrame> frame = recording.next()) frames.push_back(*frame);
  return frames;
}

TEST(AlteredRecording, EveryThirdFrame) {
  const auto all = framesOf(*room());
  const auto recording = everyNth(room(), 3);
  EXPECT_EQ(recording->frameCount(), 3u);
  const auto thirds = framesOf(*recording);
  ASSERT_EQ(thirds.size(), 3u);
  for (size_t i = 0; i < 3; ++i) EXPECT_EQ(thirds[i].stamp_s, all[3 * i].stamp_s);
}

TEST(AlteredRecording, IrregularFramesAreSomeOfThoseThereAre) {
  const auto all = framesOf(*room());
  const auto frames = framesOf(*irregular(room(), 3, 1));
  ASSERT_GE(frames.size(), 3u);
  EXPECT_LT(frames.size(), 7u);
  EXPECT_EQ(frames.front().stamp_s, all.front().stamp_s);
  for (size_t i = 1; i < frames.size(); ++i) {
    EXPECT_LT(frames[i].stamp_s - frames[i - 1].stamp_s, 3.1 / 30.0);
  }
}

TEST(AlteredRecording, LightsOffLeavesDepth) {
  const auto all = framesOf(*room());
  const auto frames = framesOf(*lightsOff(room(), 2, 3));
  ASSERT_EQ(frames.size(), 7u);
  for (size_t i = 0; i < 7; ++i) {
    EXPECT_EQ(cv::norm(frames[i].depth, all[i].depth), 0.0);
    EXPECT_EQ(cv::norm(frames[i].color) > 0.0, i < 2 || i > 4) << i;
  }
}

TEST(AlteredRecording, BlackFramesThenTheStart) {
  const auto all = framesOf(*room());
  const auto recording = interrupted(room, {2, 3});
  EXPECT_EQ(recording->frameCount(), 12u);
  const auto frames = framesOf(*recording);
  ASSERT_EQ(frames.size(), 12u);
  for (size_t i = 0; i < 7; ++i)
    EXPECT_EQ(cv::norm(frames[i].depth, all[i].depth), 0.0) << "changed afterwards?";
  for (size_t i = 7; i < 9; ++i) {
    EXPECT_EQ(cv::norm(frames[i].depth) + cv::norm(frames[i].color), 0.0);
    EXPECT_GT(frames[i].stamp_s, frames[i - 1].stamp_s);
  }
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(frames[9 + i].stamp_s, all[i].stamp_s + kRepeatedLater_s);
    EXPECT_EQ(cv::norm(frames[9 + i].depth, all[i].depth), 0.0);
  }
  const Trajectory twice = repeated({{1.0, Pose::Identity()}});
  ASSERT_EQ(twice.size(), 2u);
  EXPECT_EQ(twice[1].stamp_s, 1.0 + kRepeatedLater_s);
}

}  // namespace
}  // namespace depth_fusion
