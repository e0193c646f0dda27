#include "depth_fusion/common/stage_timers.h"

#include <gtest/gtest.h>

namespace depth_fusion {
namespace {

TEST(StageTimers, ScopesAddASampleEachToTheirStage) {
  StageTimers timers;
  {
    const StageTimers::Scope frame(timers, "frame");
    const StageTimers::Scope reduce(timers, "icp_tracking/reduce");
  }
  { const StageTimers::Scope frame(timers, "frame"); }
  ASSERT_EQ(timers.samplesMs().size(), 2u);
  EXPECT_EQ(timers.samplesMs().at("frame").size(), 2u);
  EXPECT_EQ(timers.samplesMs().at("icp_tracking/reduce").size(), 1u);
  for (const double ms : timers.samplesMs().at("frame")) EXPECT_GE(ms, 0.0);
}

}  // namespace
}  // namespace depth_fusion
