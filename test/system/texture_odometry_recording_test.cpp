// Texture odometry from frame to frame of a real recording.
#include <gtest/gtest.h>

#include <filesystem>

#include "depth_fusion/recording/recording.h"
#include "depth_fusion/recording/trajectory_file.h"
#include "depth_fusion/texture_odometry/texture_odometry.h"
#include "support/real_data.h"
#include "tools/evaluation/trajectory_error.h"

namespace depth_fusion {
namespace {

struct Chain {
  Trajectory trajectory;
  int frames = 0;
  int found = 0;
};

Chain chainMotions(const std::string& folder, int stride) {
  const std::unique_ptr<Recording> recording = openFolder(folder, {});
  TextureOdometry odometry({});
  Chain chain;
  Pose T_W_D = Pose::Identity();
  for (int i = 0; const std::optional<RgbdFrame> frame = recording->next(); ++i) {
    if (i % stride != 0) continue;
    const TextureOdometryResult result = odometry.process(*frame);
    if (result.found) T_W_D = orthonormalized(T_W_D * result.T_previous_current);
    chain.found += result.found;
    chain.trajectory.push_back({frame->stamp_s, T_W_D});
    ++chain.frames;
  }
  return chain;
}

class TumXyz : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = realDataFolder("tum_fr1_xyz");
    if (!std::filesystem::exists(folder_)) GTEST_SKIP() << folder_ << " is missing";
  }
  TrajectoryError errorOf(const Chain& chain, double interval_s) const {
    TrajectoryErrorOptions options;
    options.rpe_interval_s = interval_s;
    return compareTrajectories(chain.trajectory, readTrajectory(folder_ + "/groundtruth.txt"), options);
  }
  std::string folder_;
};

TEST_F(TumXyz, EveryFrame) {
  const Chain chain = chainMotions(folder_, 1);
  EXPECT_GT(chain.found, 0.99 * (chain.frames - 1));
  const TrajectoryError second = errorOf(chain, 1.0), frame = errorOf(chain, 1.0 / 30.0);
  EXPECT_LT(frame.rpe_translation_m.median, 0.006);
  EXPECT_LT(frame.rpe_rotation_deg.median, 0.3);
  EXPECT_LT(second.rpe_translation_m.rmse, 0.04);
  EXPECT_LT(second.rpe_rotation_deg.rmse, 2.0);
  EXPECT_LT(second.ate_m.rmse, 0.07);
}

TEST_F(TumXyz, EveryThirdFrame) {
  const Chain chain = chainMotions(folder_, 3);
  EXPECT_GT(chain.found, 0.99 * (chain.frames - 1));
}

}  // namespace
}  // namespace depth_fusion
