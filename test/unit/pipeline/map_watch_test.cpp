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

}  // namespace
}  // namespace depth_fusion
