#include "icp_tracking/frame_geometry.h"

#include <gtest/gtest.h>

#include "depth_fusion/preprocessing/depth_preprocessor.h"
#include "support/test_compute.h"
#include "tools/simulation/renderer.h"

namespace depth_fusion {
namespace {

constexpr CameraIntrinsics kCamera{160, 120, 131.25, 131.25, 79.5, 59.5};
constexpr double kWall_m = 1.5;

class BareWall : public testing::Test {
 protected:
  BareWall() : preprocessor_(compute(), {}, kCamera) {
    const Scene wall({plane({0, 0, kWall_m}, {0, 0, -1}, Material())});
    RgbdFrame frame;
    frame.depth = render(wall, kCamera, Pose::Identity()).depth_m;
    preprocessor_.process(frame);
  }
  const DepthLevel& coarsest() const { return preprocessor_.result()->levels.back(); }
  double informationAlong(int axis, const Pose& T_M_D = Pose::Identity()) const {
    return depth_fusion::informationAlong(Vector6d::Unit(axis), coarsest(), T_M_D);
  }

 private:
  DepthPreprocessor preprocessor_;
};

TEST_F(BareWall, SaysOnlyHowFarItIsAndHowItIsTilted) {
  EXPECT_NEAR(informationAlong(5), 1.0, 1e-4);
  for (const int free : {2, 3, 4}) EXPECT_NEAR(informationAlong(free), 0.0, 1e-4) << free;
  const double half_width_m = 0.5 * kCamera.width / kCamera.fx * kWall_m;
  EXPECT_NEAR(informationAlong(1), half_width_m * half_width_m / 3.0, 0.06) << "evenly spread points";
}

TEST_F(BareWall, IsSeenFromM) {
  const Pose T_M_D(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY()));
  EXPECT_NEAR(informationAlong(5, T_M_D), std::cos(0.3) * std::cos(0.3), 1e-3);
  EXPECT_NEAR(informationAlong(3, T_M_D), std::sin(0.3) * std::sin(0.3), 1e-3);
}

TEST_F(BareWall, HasTheSpreadOfItsPoints) {
  const Eigen::AlignedBox3d box = spreadBox(coarsest(), Pose::Identity());
  EXPECT_NEAR((box.center() - Eigen::Vector3d(0, 0, kWall_m)).norm(), 0.0, 0.02);
  const double half_width_m = 0.5 * kCamera.width / kCamera.fx * kWall_m;
  EXPECT_NEAR(0.5 * box.sizes().x(), half_width_m * std::sqrt(1.0 / 3.0 * (1.0 + 0.75 * 0.75)), 0.03);
}

}  // namespace
}  // namespace depth_fusion
