#include "depth_fusion/loops/loop_closer.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/loop_keyframes.h"
#include "tools/simulation/building_plan.h"

namespace depth_fusion {
namespace {

// Looks into the room from a place of its floor.
Pose inRoom(const Pose& T_W_room, int step) {
  Pose T_W_R = T_W_room;
  return T_W_R * standingAt(-1.2 + 0.25 * step, -0.6, 0.9 + 0.05 * step);
}

// Feeds a closer with keyframes as a tracker would that drifts.
class Walk {
 public:
  explicit Walk(const LoopParameters& parameters = {}) : closer(parameters) {}

  // The sensor is seen to be at T_scene_D, goes there straight, and is tracked with the error (on the right).
  LoopReport go(const Keyframe& seen, const Pose& T_scene_D, const Pose& error = Pose::Identity(),
                double detour_m = 0.0) {
    std::optional<KeyframeMotion> motion;
    if (is_under_way_) {
      motion = KeyframeMotion{T_scene_last_.inverse() * T_scene_D * error, Matrix6d::Zero()};
      way_m_ += motion->T_previous_current.translation().norm() + detour_m;
      tracked_ = tracked_ * motion->T_previous_current;
    } else {
      tracked_ = T_scene_D;
    }
    is_under_way_ = true;
    T_scene_last_ = T_scene_D;
    Keyframe keyframe = seen;
    keyframe.T_W_D = tracked_;
    keyframe.way_m = way_m_;
    const LoopReport report = closer.add(std::make_shared<const Keyframe>(std::move(keyframe)), motion);
    for (const LoopCandidate& loop : report.candidates) {
      if (loop.verdict == LoopVerdict::kClosed) ++closed;
      said.push_back(loop.text());
      verdicts.push_back(loop.verdict);
    }
    return report;
  }

  bool saw(LoopVerdict verdict) const {
    return std::find(verdicts.begin(), verdicts.end(), verdict) != verdicts.end();
  }
  std::string all() const {
    std::string text;
    for (const std::string& line : said) text += line + "\n";
    return text;
  }

  LoopCloser closer;
  int closed = 0;
  std::vector<std::string> said;
  std::vector<LoopVerdict> verdicts;

 private:
  bool is_under_way_ = false;
  Pose T_scene_last_, tracked_ = Pose::Identity();
  double way_m_ = 0.0;
};

class LoopCloserTest : public testing::Test {
 protected:
  static constexpr int kSteps = 4;
  static const LoopScene& building() {
    static const LoopScene scene("building");
    return scene;
  }
  // The keyframes of a walk into one of the rooms that are alike, at a first or another time.
  static const Keyframe& seen(int step, uint64_t time) {
    static std::map<std::pair<int, uint64_t>, Keyframe> keyframes;
    const auto known = keyframes.find({step, time});
    if (known != keyframes.end()) return known->second;
    return keyframes[{step, time}] =
               building().keyframe(inRoom(buildingTwin(0), step), Pose::Identity(), 0.0, 10 * time + step);
  }
};

TEST_F(LoopCloserTest, ALoopIsClosedOnceKeyframesAgree) {
  Walk walk;
  for (int step = 0; step < kSteps; ++step) walk.go(seen(step, 1), inRoom(buildingTwin(0), step));
  const Pose drift = motionOf({0.0, 1.5, 0.0}, {0.08, 0.0, 0.1});
  LoopReport last;
  for (int step = 0; step < kSteps; ++step) {
    const bool is_first = step == 0;
    last = walk.go(seen(step, 2), inRoom(buildingTwin(0), step), is_first ? drift : Pose::Identity(),
                   is_first ? 30.0 : 0.0);
    EXPECT_TRUE(walk.closed == 0 || step >= 2) << "too few have agreed";
  }
  ASSERT_GE(walk.closed, 3) << walk.all();
  for (int step = 0; step < kSteps; ++step) {
    const Pose error =
        inRoom(buildingTwin(0), step).inverse() * walk.closer.pose(static_cast<uint32_t>(kSteps + step));
    EXPECT_LT(error.translation().norm(), 0.015) << step;
    EXPECT_LT(rotationAngle(error), 0.01) << step;
  }
  const Corrections corrections = walk.closer.corrections();
  ASSERT_EQ(corrections.keyframes().size(), 8u);
  EXPECT_GT(
      (corrections.keyframes()[7].T_W_now.translation() - corrections.keyframes()[7].T_W_then.translation())
          .norm(),
      0.1);
}

TEST_F(LoopCloserTest, AnotherRoomThatIsAlikeIsNoLoop) {
  for (const float reach_m : {8.0f, 1000.0f}) {
    LoopParameters parameters;
    parameters.reach_m = reach_m;
    Walk walk(parameters);
    for (int step = 0; step < kSteps; ++step) walk.go(seen(step, 1), inRoom(buildingTwin(0), step));
    for (int step = 0; step < kSteps; ++step)
      walk.go(seen(step, 2), inRoom(buildingTwin(1), step), Pose::Identity(), step == 0 ? 30.0 : 0.0);
    EXPECT_EQ(walk.closed, 0) << walk.all();
    EXPECT_TRUE(walk.saw(reach_m < 100.0f ? LoopVerdict::kOutOfReach : LoopVerdict::kBeyondDrift))
        << walk.all();
  }
}

TEST_F(LoopCloserTest, ASingleLoopIsNotBelieved) {
  Walk walk;
  for (int step = 0; step < kSteps; ++step) walk.go(seen(step, 1), inRoom(buildingTwin(0), step));
  const LoopReport report = walk.go(seen(1, 2), inRoom(buildingTwin(0), 1), Pose::Identity(), 30.0);
  EXPECT_FALSE(report.poses_changed);
  EXPECT_EQ(walk.closed, 0);
  EXPECT_TRUE(walk.saw(LoopVerdict::kUnconfirmed)) << walk.all();
}

// A corridor that is the same every 3 m shows the same keyframe again and again.
TEST_F(LoopCloserTest, ACorridorThatRepeatsItselfIsNoLoop) {
  Walk walk;
  for (int bay = 0; bay < 6; ++bay) {
    for (int step = 0; step < 3; ++step) {
      Pose T_scene_D = inRoom(buildingTwin(0), step);
      T_scene_D.translation().x() += 3.0 * bay;
      walk.go(seen(step, static_cast<uint64_t>(1 + bay % 2)), T_scene_D);
    }
  }
  EXPECT_EQ(walk.closed, 0) << walk.all();
  EXPECT_TRUE(walk.saw(LoopVerdict::kBeyondDrift)) << walk.all();
}

// After a long way drift says no more which of the bays it is.
TEST_F(LoopCloserTest, PlacesThatCannotBeToldApartAreNotChosenBetween) {
  Walk walk;
  const auto at = [](int bay, int step) {
    Pose T_scene_D = inRoom(buildingTwin(0), step);
    T_scene_D.translation().x() += 3.0 * bay;
    return T_scene_D;
  };
  for (int bay = 0; bay < 2; ++bay) {
    for (int step = 0; step < 3; ++step) walk.go(seen(step, 1), at(bay, step));
  }
  for (int step = 0; step < 3; ++step)
    walk.go(seen(step, 2), at(1, step), Pose::Identity(), step == 0 ? 3000.0 : 0.0);
  EXPECT_EQ(walk.closed, 0) << walk.all();
  EXPECT_TRUE(walk.saw(LoopVerdict::kAmbiguous)) << walk.all();
}

TEST_F(LoopCloserTest, AnotherSessionIsJoined) {
  LoopParameters parameters;
  parameters.agreeing_loops = 2;
  std::vector<KeyframePtr> shelf;
  LoopCloser closer(parameters, [&](uint32_t number) { return shelf.at(number); });
  const auto add = [&](int step, uint64_t time, const Pose& T_W_D, bool begins) {
    Keyframe keyframe = seen(step, time);
    keyframe.T_W_D = T_W_D;
    keyframe.way_m = 0.25 * step + 10.0 * static_cast<double>(time);
    shelf.push_back(std::make_shared<const Keyframe>(std::move(keyframe)));
    std::optional<KeyframeMotion> motion;
    if (!begins)
      motion = KeyframeMotion{inRoom(buildingTwin(0), step - 1).inverse() * inRoom(buildingTwin(0), step),
                              Matrix6d::Zero()};
    return closer.add(shelf.back(), motion);
  };
  for (int step = 0; step < kSteps; ++step) add(step, 1, inRoom(buildingTwin(0), step), step == 0);
  Pose elsewhere = Pose::Identity();
  elsewhere.translation().y() = 77.0;
  LoopReport last;
  for (int step = 0; step < kSteps; ++step) last = add(step, 2, elsewhere, step == 0);
  EXPECT_TRUE(last.poses_changed) << "twice as many have to agree";
  for (int step = 0; step < kSteps; ++step) {
    const Pose error =
        inRoom(buildingTwin(0), step).inverse() * closer.pose(static_cast<uint32_t>(kSteps + step));
    EXPECT_LT(error.translation().norm(), 0.02) << step;
  }
}

}  // namespace
}  // namespace depth_fusion
