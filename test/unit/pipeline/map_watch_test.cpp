#include "depth_fusion/pipeline/map_watch.h"

#include <gtest/gtest.h>

namespace depth_fusion {
namespace {

constexpr double kFrame_s = 0.1;

// A watch that is shown frames which fit the map so far.
class WatchedMap {
 public:
  // So many frames of which the map contradicts a part of the points, and fits the others so well.
  void show(int frames, double contradicted, double match_quality, int guessed_directions = 0) {
    TrackingResult result;
    result.status = guessed_directions > 0 ? TrackingStatus::kDegenerate : TrackingStatus::kTracking;
    result.reason = guessed_directions > 0 ? "sliding along x" : "";
    result.guessed_directions = guessed_directions;
    result.match_quality = match_quality;
    result.explained = match_quality * (1.0 - contradicted);
    for (int i = 0; i < frames; ++i) watch_.add(kFrame_s * shown_++, result);
  }
  std::string doubt() const { return watch_.doubt(); }

 private:
  MapWatch watch_;
  int shown_ = 0;
};

TEST(MapWatch, TrustsAMapThatFitsAsUsual) {
  WatchedMap map;
  map.show(1, 0.0, 0.0);  // the frame that begins it
  map.show(100, 0.1, 0.8);
  map.show(20, 0.5, 0.8);  // somebody walks by
  map.show(100, 0.15, 0.75);
  EXPECT_EQ(map.doubt(), "");
}

TEST(MapWatch, DoubtsAMapThatIsContradictedForLong) {
  WatchedMap map;
  map.show(100, 0.1, 0.8);
  map.show(60, 0.45, 0.8);
  EXPECT_NE(map.doubt().find("the map may be wrong since 11."), std::string::npos) << map.doubt();
  EXPECT_NE(map.doubt().find("contradict"), std::string::npos) << map.doubt();
  const std::string doubt = map.doubt();
  map.show(500, 0.1, 0.8);
  EXPECT_EQ(map.doubt(), doubt) << "what was fused stays";
}

TEST(MapWatch, DoubtsAMapThatFitsWorseAndWorse) {
  WatchedMap map;
  map.show(60, 0.1, 0.8);
  for (int i = 0; i < 100; ++i) map.show(1, 0.1, 0.8 - 0.003 * i);
  EXPECT_NE(map.doubt(), "");
}

TEST(MapWatch, DoubtsAMapWhosePosesWereGuessed) {
  WatchedMap map;
  map.show(10, 0.1, 0.8);
  map.show(4, 0.1, 0.8, 1);
  map.show(10, 0.1, 0.8);
  EXPECT_EQ(map.doubt(), "");
  map.show(6, 0.1, 0.8, 1);
  EXPECT_NE(map.doubt().find("since 2.4"), std::string::npos) << map.doubt();
  EXPECT_NE(map.doubt().find("sliding along x"), std::string::npos) << map.doubt();
}

// Compares so many frames with an older view, which puts the sensor so far away; returns how many of them the
// watch asked for.
int compare(MapWatch& watch, int frames, double away_m) {
  static double stamp_s = 0.0;
  Pose T_D_older = Pose::Identity();
  T_D_older.translation().x() = away_m;
  int compared = 0;
  for (int i = 0; i < frames; ++i, stamp_s += kFrame_s) {
    if (!watch.wantsComparison()) continue;
    watch.compare(stamp_s, T_D_older);
    ++compared;
  }
  return compared;
}

TEST(MapWatch, ComparesSomeFramesWithAnOlderViewAndMoreOfThemWhereTheyDiffer) {
  MapWatch watch;
  EXPECT_EQ(compare(watch, 150, 0.01), 10);
  EXPECT_EQ(compare(watch, 15 + 3, 0.04), 4);
  EXPECT_EQ(watch.doubt(), "") << "it may have been a passer-by";
  EXPECT_EQ(compare(watch, 16, 0.01), 2);
  EXPECT_EQ(watch.doubt(), "");
}

TEST(MapWatch, DoubtsAMapThatMovesAlongWithWrongPoses) {
  MapWatch watch;
  compare(watch, 15, 0.01);
  compare(watch, 15 + 4, 0.04);
  EXPECT_NE(watch.doubt().find("the map may be wrong since "), std::string::npos) << watch.doubt();
  EXPECT_NE(watch.doubt().find("40 mm"), std::string::npos) << watch.doubt();
  EXPECT_FALSE(watch.wantsComparison()) << "it is doubted for good";
}

// Between frames that differ, some cannot be compared.
TEST(MapWatch, WhatCannotBeComparedDecidesNothing) {
  Pose away = Pose::Identity();
  away.translation().x() = 0.1;
  MapWatch watch;
  EXPECT_FALSE(watch.waitsForComparison()) << "nothing has differed";
  for (int frame = 0; frame < 5; ++frame) {
    EXPECT_EQ(watch.doubt(), "");
    watch.compare(0.1 * frame, away);
    if (frame < 4) {
      EXPECT_TRUE(watch.waitsForComparison());
    }
  }
  EXPECT_NE(watch.doubt(), "");
  MapWatch gives_up;
  gives_up.compare(0.0, away);
  for (int frame = 0; frame < 5; ++frame) EXPECT_TRUE(gives_up.waitsForComparison());
  EXPECT_FALSE(gives_up.waitsForComparison());
}

}  // namespace
}  // namespace depth_fusion
