// One publisher of a topic is listened to, and what it sent in vain is counted.
#include "ros/input/publisher_watch.h"

#include <gtest/gtest.h>

#include <vector>

namespace depth_fusion {
namespace {

class PublisherWatchTest : public testing::Test {
 protected:
  PublisherWatch::Verdict judge(const std::string& publisher, uint32_t seq, uint32_t publishers = 1) {
    now_ += ros::WallDuration(0.033);
    return watch_.judge(publisher, seq, publishers, now_);
  }

  PublisherWatch watch_;
  ros::WallTime now_{1000.0};
};

TEST_F(PublisherWatchTest, CountsMessagesThatDidNotCome) {
  EXPECT_EQ(judge("/camera", 6).missed, 0u) << "those before were sent to others";
  EXPECT_EQ(judge("/camera", 7).missed, 0u);
  EXPECT_EQ(judge("/camera", 8).missed, 0u);
  EXPECT_EQ(judge("/camera", 12).missed, 3u);
  EXPECT_EQ(judge("/camera", 13).missed, 0u);
}

// As a network does that loses one message in three.
TEST_F(PublisherWatchTest, CountsThemWhereManyAreLost) {
  uint32_t seq = 0, taken = 0, missed = 0;
  for (const uint32_t step : {1u, 1u, 1u, 1u, 2u, 1u, 2u, 1u, 1u, 2u, 1u, 1u, 1u, 3u, 1u, 1u, 1u}) {
    missed += judge("/camera", seq += step).missed;
    ++taken;
  }
  EXPECT_EQ(taken + missed, seq);
}

// What topic_tools' throttle and drop leave of a topic is all that was sent.
TEST_F(PublisherWatchTest, ThinnedOutTopicsLoseNothing) {
  const std::vector<std::vector<uint32_t>> patterns = {{3}, {2}, {4, 5}, {1, 2}, {6, 7, 7}, {1, 3}};
  for (const std::vector<uint32_t>& steps : patterns) {
    watch_ = PublisherWatch();
    uint32_t seq = 100;
    for (size_t i = 0; i < 60; ++i)
      EXPECT_EQ(judge("/throttle", seq += steps[i % steps.size()]).missed, 0u) << steps[0] << ", " << i;
  }
}

TEST_F(PublisherWatchTest, NumbersThatMeanNothingCountNothing) {
  for (const uint32_t seq : {0u, 0u, 5000000u, 3u, 3u, 2u}) {
    const PublisherWatch::Verdict verdict = judge("/camera", seq);
    EXPECT_TRUE(verdict.is_taken) << seq;
    EXPECT_EQ(verdict.missed, 0u) << seq;
  }
}

TEST_F(PublisherWatchTest, OfTwoPublishersTheFirstIsTaken) {
  for (uint32_t i = 1; i < 50; ++i) {
    EXPECT_TRUE(judge("/first", i, 2).is_taken);
    EXPECT_EQ(watch_.other(), i == 1 ? "" : "/second");
    EXPECT_FALSE(judge("/second", 100 * i, 2).is_taken);
  }
  EXPECT_EQ(watch_.publisher(), "/first");
  EXPECT_EQ(judge("/first", 50, 2).missed, 0u);
}

TEST_F(PublisherWatchTest, TheOtherTakesOverAfterTheFirst) {
  judge("/first", 1, 2);
  EXPECT_FALSE(judge("/second", 7, 2).is_taken);
  now_ += ros::WallDuration(2.0);
  const PublisherWatch::Verdict verdict = judge("/second", 90, 2);
  EXPECT_TRUE(verdict.is_taken) << "the first is silent";
  EXPECT_EQ(verdict.missed, 0u);
  EXPECT_TRUE(judge("/third", 1, 1).is_taken) << "a camera's node was started anew";
  EXPECT_EQ(watch_.other(), "");
}

}  // namespace
}  // namespace depth_fusion
