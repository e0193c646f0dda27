// Which colour goes with which depth, and how long depth waits for it.
#include "ros/input/rgbd_pairing.h"

#include <gtest/gtest.h>

#include <boost/make_shared.hpp>

namespace depth_fusion {
namespace {

constexpr float kMaxGap_s = 0.02f;
constexpr float kMaxWait_s = 0.1f;
const ros::WallTime kNow(1000.0);

class RgbdPairingTest : public testing::Test {
 protected:
  void addDepth(double stamp_s) {
    auto messages = std::make_shared<RgbdMessages>();
    messages->header.stamp = ros::Time(stamp_s);
    messages->received = kNow;
    pairing_.addDepth(messages);
  }
  void addColor(double stamp_s) {
    auto image = boost::make_shared<sensor_msgs::Image>();
    image->header.stamp = ros::Time(stamp_s);
    pairing_.addColor(image->header.stamp, {image, nullptr});
  }
  bool isComplete(double waited_s = 0.0, bool color_comes = true) const {
    return pairing_.firstIsComplete(kNow + ros::WallDuration(waited_s), color_comes);
  }
  // Takes the first out, and checks that it is that depth with that colour; 0 stands for none.
  void expectPair(double depth_s, double color_s) {
    ASSERT_NE(pairing_.first(), nullptr);
    const RgbdMessagesPtr pair = pairing_.takeFirst();
    EXPECT_EQ(pair->header.stamp, ros::Time(depth_s));
    EXPECT_EQ(pair->color.empty() ? ros::Time() : pair->color.header().stamp, ros::Time(color_s));
  }

  RgbdPairing pairing_{PairingParameters{kMaxGap_s, kMaxWait_s}};
};

TEST_F(RgbdPairingTest, EachDepthGetsTheColourNearestInTime) {
  for (const double color_s : {100.0, 100.033, 100.066, 100.1}) addColor(color_s);
  for (const double depth_s : {100.004, 100.031, 100.07}) addDepth(depth_s);
  expectPair(100.004, 100.0);
  expectPair(100.031, 100.033);
  expectPair(100.07, 100.066);
  EXPECT_EQ(pairing_.first(), nullptr);
}

TEST_F(RgbdPairingTest, ColourFartherThanTheGapIsLeftOut) {
  addColor(100.03);
  addDepth(100.0);
  addDepth(100.005);
  EXPECT_TRUE(isComplete());
  expectPair(100.0, 0.0);
  pairing_.setParameters({0.03f, kMaxWait_s});
  expectPair(100.005, 100.03);
}

TEST_F(RgbdPairingTest, DepthWaitsForItsColour) {
  addDepth(100.0);
  addColor(99.99);
  EXPECT_FALSE(isComplete(0.09)) << "nearer colour may still come";
  EXPECT_TRUE(isComplete(0.11));
  addColor(100.0);
  EXPECT_TRUE(isComplete());
  expectPair(100.0, 100.0);
}

TEST_F(RgbdPairingTest, DepthDoesNotWaitWhereNobodyPublishesColour) {
  addDepth(100.0);
  EXPECT_FALSE(isComplete(0.0, true));
  EXPECT_TRUE(isComplete(0.0, false));
  addColor(99.99);
  EXPECT_FALSE(isComplete(0.0, false)) << "somebody has just published some";
}

TEST_F(RgbdPairingTest, AClockSetBackLeavesNothingFromBefore) {
  for (const double stamp_s : {100.0, 100.033}) {
    addDepth(stamp_s);
    addColor(stamp_s);
  }
  addColor(50.0);  // of the new time, and a little before its depth
  EXPECT_EQ(pairing_.restart(ros::Time(50.001)), 2u);
  EXPECT_EQ(pairing_.first(), nullptr);
  addDepth(50.001);
  EXPECT_FALSE(isComplete()) << "colour from before the jump completes nothing";
  expectPair(50.001, 50.0);
  addDepth(100.0);
  expectPair(100.0, 0.0);
}

TEST_F(RgbdPairingTest, ColourOfAnotherClockIsSaid) {
  std::string problem;
  for (int i = 0; i < 10; ++i) {
    addColor(100.0 + 0.033 * i);
    addDepth(500.0 + 0.033 * i);
    const RgbdMessagesPtr taken = pairing_.takeFirst();
    EXPECT_TRUE(taken->color.empty());
    problem = taken->color_problem;
  }
  EXPECT_NE(problem.find("400 s earlier"), std::string::npos) << problem;
  addColor(501.0);
  addDepth(501.0);
  EXPECT_EQ(pairing_.takeFirst()->color_problem, "");
  addDepth(501.03);
  EXPECT_EQ(pairing_.takeFirst()->color_problem, "") << "one without is none";
}

TEST_F(RgbdPairingTest, OnlyTheLatestColourIsKept) {
  for (int i = 0; i <= 30; ++i) addColor(100.0 + i);
  addDepth(100.0);
  addDepth(101.0);
  expectPair(100.0, 0.0);
  expectPair(101.0, 101.0);
}

}  // namespace
}  // namespace depth_fusion
