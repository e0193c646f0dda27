#include "depth_fusion/relocalisation/relocaliser.h"

#include <gtest/gtest.h>

#include "depth_fusion/texture_odometry/texture_odometry.h"
#include "tools/simulation/simulated_recording.h"

namespace depth_fusion {
namespace {

Pose at(double x_m, double turn_rad = 0.0) {
  Pose pose(Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitY()));
  pose.translation().x() = x_m;
  return pose;
}

const FrameFeatures& someFeatures() {
  static const FrameFeatures features = [] {
    SimulatedRecording recording{SimulationOptions()};
    return TextureOdometry({}).extract(*recording.next());
  }();
  return features;
}

TEST(Relocaliser, KeepsOnlyFramesFarFromEachOther) {
  RelocalisationParameters parameters;
  parameters.keyframe_distance_m = 0.2f;
  parameters.keyframe_angle_rad = 0.25f;
  Relocaliser relocaliser(parameters);
  relocaliser.add(0.0, someFeatures(), at(0.0));
  relocaliser.add(0.0, someFeatures(), at(0.19));
  relocaliser.add(0.0, someFeatures(), at(0.0, 0.24));
  EXPECT_EQ(relocaliser.keyframes().size(), 1u);
  relocaliser.add(0.0, someFeatures(), at(0.21));
  relocaliser.add(0.0, someFeatures(), at(0.0, 0.26));
  ASSERT_EQ(relocaliser.keyframes().size(), 3u);
  EXPECT_TRUE(relocaliser.keyframes()[0]->features.smoothed_levels.empty()) << "too large to keep";
  relocaliser.reset();
  EXPECT_TRUE(relocaliser.keyframes().empty());
}

TEST(Relocaliser, LowerLimitDropsAtOnce) {
  RelocalisationParameters parameters;
  Relocaliser relocaliser(parameters);
  for (const double x_m : {0.0, 1.0, 2.0}) relocaliser.add(0.0, someFeatures(), at(x_m));
  parameters.max_keyframes = 0;
  relocaliser.setParameters(parameters);
  EXPECT_TRUE(relocaliser.keyframes().empty());
}

TEST(Relocaliser, DropsTheMostCrowdedWhenFull) {
  RelocalisationParameters parameters;
  parameters.keyframe_distance_m = 0.2f;
  parameters.max_keyframes = 3;
  Relocaliser relocaliser(parameters);
  for (const double x_m : {0.0, 1.0, 1.25, 3.0}) relocaliser.add(0.0, someFeatures(), at(x_m));
  ASSERT_EQ(relocaliser.keyframes().size(), 3u);
  EXPECT_EQ(relocaliser.keyframes()[0]->T_W_D.translation().x(), 0.0);
  EXPECT_EQ(relocaliser.keyframes()[1]->T_W_D.translation().x(), 1.25);
  EXPECT_EQ(relocaliser.keyframes()[2]->T_W_D.translation().x(), 3.0);
}

TEST(Relocaliser, FramesWithoutFeaturesAreNoKeyframesAndHaveNoCandidates) {
  Relocaliser relocaliser({});
  FrameFeatures none;
  none.reason = "no colour image";
  relocaliser.add(0.0, none, at(0.0));
  EXPECT_TRUE(relocaliser.keyframes().empty());
  relocaliser.add(0.0, someFeatures(), at(0.0));
  EXPECT_TRUE(relocaliser.candidates(none).empty());
}

TEST(Relocaliser, KeyframesThatLookAlikeComeFirst) {
  RelocalisationParameters parameters;
  parameters.keyframe_distance_m = 0.05f;
  parameters.keyframe_angle_rad = 0.05f;
  parameters.max_candidates = 3;
  Relocaliser relocaliser(parameters);
  const TextureOdometry odometry({});
  SimulationOptions six_a_second;
  six_a_second.fps = 6.0;
  SimulatedRecording recording(six_a_second);
  std::vector<FrameFeatures> between;
  std::vector<Pose> poses;
  for (int i = 0; i < 32; ++i) {
    const RgbdFrame frame = *recording.next();
    if (i % 6 == 0) relocaliser.add(frame.stamp_s, odometry.extract(frame), *frame.T_W_D);
    if (i % 6 != 1) continue;
    between.push_back(odometry.extract(frame));
    poses.push_back(*frame.T_W_D);
  }
  ASSERT_GE(relocaliser.keyframes().size(), 5u);
  for (size_t i = 0; i < between.size(); ++i) {
    const Keyframes candidates = relocaliser.candidates(between[i]);
    ASSERT_EQ(candidates.size(), 3u);
    const TextureOdometryResult motion = odometry.match(candidates[0]->features, between[i], true);
    ASSERT_TRUE(motion.found) << i << " " << motion.reason;
    const Pose found = motion.priorFrom(candidates[0]->T_W_D).T_W_D;
    EXPECT_LT((found.translation() - poses[i].translation()).norm(), 0.01) << i;
  }
}

}  // namespace
}  // namespace depth_fusion
