#include "depth_fusion/pipeline/loop_closing.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "depth_fusion/compute/device_image.h"
#include "support/loop_keyframes.h"
#include "support/test_compute.h"

namespace depth_fusion {
namespace {

constexpr int kStepsOfARound = 20, kLastSteps = 4;
constexpr double kRadius_m = 0.5, kTurn_rad = 2.0 * CV_PI / kStepsOfARound;
constexpr double kDrift = 0.03;  // of the way

// A sensor that turns in the middle of a room, round after round, while its tracked poses drift away.
class Rounds {
 public:
  explicit Rounds(const LoopParameters& parameters = {}) : loops(parameters) {}

  void goOn(int steps) {
    for (int i = 0; i < steps; ++i) {
      const double angle = kTurn_rad * static_cast<double>(truth_.size());
      const Pose T_scene_D = standingAt(kRadius_m * std::cos(angle), kRadius_m * std::sin(angle), angle);
      RgbdFrame frame = scene_.frame(T_scene_D, truth_.size());
      frame.stamp_s = 0.1 * static_cast<double>(truth_.size());
      tracked_.push_back(T_scene_D);
      tracked_.back().translation().x() += kDrift * kRadius_m * angle;
      truth_.push_back(T_scene_D);
      ModelView view{frame.intrinsics, T_scene_D, zeroImage(compute(), frame.intrinsics), {}};
      cv::Mat depth_m;
      frame.depth.convertTo(depth_m, CV_32F, frame.depth_unit_m);
      writeImage(view.depth, frame.intrinsics, depth_m);
      stamps_s_.push_back(frame.stamp_s);
      loops.add(frame, odometry_.extract(frame), tracked_.back(), view);
    }
  }

  // How far the last poses are off from where they are seen from those a round before, at most.
  double errorOfLastSteps_m(const Corrections& corrections) const {
    double error_m = 0.0;
    for (size_t now = truth_.size() - kLastSteps; now < truth_.size(); ++now) {
      const size_t before = now - kStepsOfARound;
      const auto corrected = [&](size_t i) { return corrections.corrected({stamps_s_[i], tracked_[i]}); };
      const Pose relation = corrected(before).inverse() * corrected(now);
      const Pose true_relation = truth_[before].inverse() * truth_[now];
      error_m = std::max(error_m, (relation.translation() - true_relation.translation()).norm());
    }
    return error_m;
  }

  LoopClosing loops;

 private:
  LoopScene scene_{"large_room"};
  TextureOdometry odometry_{{}};
  std::vector<Pose> truth_, tracked_;
  std::vector<double> stamps_s_;
};

size_t closedIn(const std::vector<LoopCandidate>& candidates) {
  return static_cast<size_t>(
      std::count_if(candidates.begin(), candidates.end(),
                    [](const LoopCandidate& loop) { return loop.verdict == LoopVerdict::kClosed; }));
}

TEST(LoopClosing, TakesDriftOutOfPosesWhereThePlaceIsSeenAgain) {
  Rounds rounds;
  rounds.goOn(kStepsOfARound + kLastSteps);
  rounds.loops.finish();
  EXPECT_GT(rounds.errorOfLastSteps_m({}), 0.08);
  EXPECT_LT(rounds.errorOfLastSteps_m(rounds.loops.corrections()), 0.035);
  EXPECT_GE(closedIn(rounds.loops.takeCandidates()), 3u);
  EXPECT_TRUE(rounds.loops.takeCandidates().empty()) << "they were taken";
  EXPECT_EQ(rounds.loops.problem(), "");
}

TEST(LoopClosing, SaysNothingBeforeAPlaceIsSeenAgain) {
  Rounds rounds;
  rounds.goOn(kStepsOfARound / 2);
  rounds.loops.finish();
  EXPECT_TRUE(rounds.loops.corrections().keyframes().empty());
  EXPECT_EQ(closedIn(rounds.loops.takeCandidates()), 0u);
}

TEST(LoopClosing, KeyframesAreApart) {
  LoopParameters parameters;
  parameters.keyframe_distance_m = 10.0f;
  parameters.keyframe_angle_rad = 3.0f;
  Rounds rounds(parameters);
  rounds.goOn(kStepsOfARound);
  rounds.loops.finish();
  ASSERT_EQ(rounds.loops.keyframes().keyframes().size(), 2u);
  EXPECT_NEAR(rounds.loops.keyframe(1)->way_m, CV_PI * kRadius_m, 0.2) << "all frames count for the way";
  EXPECT_TRUE(rounds.loops.takeCandidates().empty());
}

// Whoever ends in the middle of it waits for one comparison at most, and nothing breaks.
TEST(LoopClosing, EndsAtAnyTime) {
  Rounds rounds;
  rounds.goOn(kStepsOfARound + 5);
}

}  // namespace
}  // namespace depth_fusion
