#include "tools/report/run_record.h"

#include <gtest/gtest.h>

namespace depth_fusion {
namespace {

RgbdFrame frameAt(double stamp_s) {
  RgbdFrame frame;
  frame.stamp_s = stamp_s;
  frame.depth = cv::Mat(48, 64, CV_16UC1, cv::Scalar(1500));
  frame.depth_unit_m = 0.001;
  return frame;
}

void note(RunRecord& record, TrackingStatus status, double explained, const std::string& prior = "texture") {
  TrackingResult tracking;
  tracking.status = status;
  tracking.prior = prior;
  tracking.explained = explained;
  record.note(frameAt(0.1 * static_cast<double>(record.frames().size())), tracking, 0);
}

constexpr auto kGood = TrackingStatus::kTracking;

TEST(RunRecord, KeepsTheWorstFramesApart) {
  RunRecord record;
  for (int i = 0; i < 1000; ++i) {
    if (i % 100 == 50)
      note(record, TrackingStatus::kLost, 0.0);
    else if (i % 100 == 55)
      note(record, kGood, 0.1);
    else if (i == 310)
      note(record, TrackingStatus::kDegenerate, 0.7);
    else
      note(record, kGood, 0.95);
  }
  ASSERT_EQ(record.worst().size(), 8u);
  for (size_t i = 0; i < record.worst().size(); ++i) {
    EXPECT_EQ(record.worst()[i].frame % 100, 50u);
    EXPECT_EQ(record.worst()[i].picture.type(), CV_8UC3);
    if (i == 0) continue;
    EXPECT_GT(record.worst()[i].frame, record.worst()[i - 1].frame);
  }
}

TEST(RunRecord, AWorseFrameTakesItsNeighboursPlace) {
  RunRecord record;
  note(record, kGood, 0.95);
  note(record, kGood, 0.4);
  note(record, kGood, 0.2);
  note(record, kGood, 0.5);
  ASSERT_EQ(record.worst().size(), 1u);
  EXPECT_EQ(record.worst()[0].frame, 2u);
}

TEST(RunRecord, GoodFramesAndThoseAtGivenPosesAreNotBad) {
  RunRecord record;
  for (int i = 0; i < 50; ++i) note(record, kGood, 0.9);
  note(record, kGood, 0.0, "");
  EXPECT_TRUE(record.worst().empty());
  EXPECT_FALSE(record.frames().back().is_tracked);
}

TEST(RunRecord, CountsLossesInARow) {
  RunRecord record;
  for (const int lost : {0, 1, 1, 0, 0, 1}) note(record, lost != 0 ? TrackingStatus::kLost : kGood, 0.9);
  const std::vector<LostFrames> losses = lossesOf(record.frames());
  ASSERT_EQ(losses.size(), 2u);
  EXPECT_EQ(losses[0].first, 1u);
  EXPECT_EQ(losses[0].count, 2u);
  EXPECT_EQ(losses[1].first, 5u);
  EXPECT_EQ(countOf(record.frames(), TrackingStatus::kLost), 3u);
}

TEST(RunRecord, WhatIsBeforeANewMapIsLost) {
  RunRecord record;
  note(record, kGood, 0.0, "start");
  note(record, kGood, 0.9);
  note(record, kGood, 0.0, "start");
  EXPECT_EQ(countOf(record.frames(), TrackingStatus::kLost), 2u);
  EXPECT_NE(record.frames()[1].reason.find("given up"), std::string::npos);
}

}  // namespace
}  // namespace depth_fusion
