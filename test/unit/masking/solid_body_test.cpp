// What of depth lies in a robot's body.
#include "depth_fusion/masking/solid_body.h"

#include <gtest/gtest.h>

#include "support/expect_error.h"
#include "tools/simulation/renderer.h"

namespace depth_fusion {
namespace {

constexpr CameraIntrinsics kCamera{160, 120, 130.0, 140.0, 79.5, 59.5};

RgbdFrame frameOf(const Scene& scene) {
  RgbdFrame frame;
  frame.intrinsics = kCamera;
  frame.depth = render(scene, kCamera, Pose::Identity()).depth_m;
  return frame;
}

RgbdFrame inMillimetres(RgbdFrame frame) {
  frame.depth.convertTo(frame.depth, CV_16UC1, 1000.0);
  frame.depth_unit_m = 0.001;
  return frame;
}

Eigen::Vector3d pointOf(int x, int y, double z) {
  return {z * (x - kCamera.cx) / kCamera.fx, z * (y - kCamera.cy) / kCamera.fy, z};
}

Pose posed(const Eigen::Vector3d& position, double angle) {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d(1.0, 2.0, 0.5).normalized()).toRotationMatrix();
  pose.translation() = position;
  return pose;
}

TEST(SolidBody, TheArmIsCutOutAndTheRoomStays) {
  const Eigen::Vector3d middle(0.1, 0.05, 0.8);
  const std::vector<Primitive> walls = {room({0.0, 0.0, 0.5}, {4.0, 3.0, 4.0}, {})};
  std::vector<Primitive> with_arm = walls;
  with_arm.push_back(box(middle, {0.6, 0.1, 0.1}, {}));
  const RgbdFrame empty = frameOf(Scene(walls));
  RgbdFrame frame = frameOf(Scene(with_arm));
  PlacedSolid arm;
  arm.T_D_S.translation() = middle;
  arm.solid = Solid::box({0.6, 0.1, 0.1});
  const size_t cut = cutOut(frame, {arm}, 0.01);
  size_t without = 0;
  for (int y = 0; y < kCamera.height; ++y) {
    for (int x = 0; x < kCamera.width; ++x) {
      const float depth = frame.depth.at<float>(y, x);
      without += depth == 0.0f;
      if (depth != 0.0f) {
        EXPECT_FLOAT_EQ(depth, empty.depth.at<float>(y, x));
      }
    }
  }
  EXPECT_EQ(without, cut);
  EXPECT_GT(cut, 1000u);
}

// Solids of each kind, some beside the image, behind the camera and around it.
TEST(SolidBody, PixelsAreCutOutThatLieInSolidsAndNoOthers) {
  const Scene scene({room({0.0, 0.0, 0.5}, {4.0, 3.0, 4.0}, {}), sphere({0.3, 0.1, 1.2}, 0.4, {})});
  const std::vector<Solid> solids = {Solid::box({0.9, 0.5, 1.4}), Solid::sphere(0.6),
                                     Solid::cylinder(0.4, 1.9)};
  size_t cut = 0;
  for (const Solid& solid : solids) {
    for (const Eigen::Vector3d& at :
         {Eigen::Vector3d(0.3, 0.0, 1.0), Eigen::Vector3d(1.3, -0.5, 2.2), Eigen::Vector3d(-1.1, 0.9, 0.4),
          Eigen::Vector3d(0.0, 0.1, 0.2), Eigen::Vector3d(0.2, 0.0, -1.5)}) {
      for (const RgbdFrame& frame : {frameOf(scene), inMillimetres(frameOf(scene))}) {
        const PlacedSolid placed{posed(at, 0.7), solid};
        RgbdFrame result = frame;
        cutOut(result, {placed}, 0.02);
        ASSERT_NE(result.depth.data, frame.depth.data);
        for (int y = 0; y < kCamera.height; ++y) {
          for (int x = 0; x < kCamera.width; ++x) {
            const bool is_metres = frame.depth.type() == CV_32FC1;
            const double before = is_metres ? frame.depth.at<float>(y, x) : frame.depth.at<uint16_t>(y, x);
            const double after = is_metres ? result.depth.at<float>(y, x) : result.depth.at<uint16_t>(y, x);
            const Eigen::Vector3d p_S = placed.T_D_S.inverse() * pointOf(x, y, frame.depth_unit_m * before);
            const bool is_inside = before > 0.0 && solid.contains(p_S, 0.02);
            ASSERT_EQ(after, is_inside ? 0.0 : before) << x << ", " << y << " at " << at.transpose();
            cut += is_inside;
          }
        }
      }
    }
  }
  EXPECT_GT(cut, 10000u);
}

TEST(SolidBody, ContainsWhatIsInItAndNearIt) {
  const Solid box = Solid::box({0.2, 0.4, 0.6}), ball = Solid::sphere(0.5), can = Solid::cylinder(0.1, 0.6);
  EXPECT_TRUE(box.contains({0.09, -0.19, 0.29}, 0.0));
  EXPECT_FALSE(box.contains({0.11, 0.0, 0.0}, 0.0));
  EXPECT_TRUE(box.contains({0.11, 0.0, 0.0}, 0.02));
  EXPECT_TRUE(ball.contains({0.3, 0.3, 0.2}, 0.0));
  EXPECT_FALSE(ball.contains({0.4, 0.4, 0.0}, 0.0));
  EXPECT_TRUE(can.contains({0.07, 0.07, 0.29}, 0.0));
  EXPECT_FALSE(can.contains({0.08, 0.08, 0.0}, 0.0));
  EXPECT_FALSE(can.contains({0.0, 0.0, 0.31}, 0.0));
}

TEST(SolidBody, IsReadFromText) {
  const std::vector<BodyPart> parts = parseBody(
      "base_link box 0.1 0 0.2 0.4 0.3 0.5; tool sphere 0 0 .05 0.12;\n arm cylinder 0 0 0 0.05 0.6;");
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(parts[0].frame, "base_link");
  EXPECT_EQ(parts[0].T_F_S.translation(), Eigen::Vector3d(0.1, 0.0, 0.2));
  EXPECT_EQ(parts[0].solid.kind, Solid::Kind::kBox);
  EXPECT_TRUE(parts[0].solid.half_m.isApprox(Eigen::Vector3d(0.2, 0.15, 0.25)));
  EXPECT_EQ(parts[1].solid.kind, Solid::Kind::kSphere);
  EXPECT_DOUBLE_EQ(parts[1].solid.half_m.x(), 0.12);
  EXPECT_EQ(parts[2].frame, "arm");
  EXPECT_TRUE(parts[2].solid.half_m.isApprox(Eigen::Vector3d(0.05, 0.05, 0.3)));
  EXPECT_TRUE(parseBody(" ").empty());
  for (const char* text : {"base", "base box 0 0 0 1 1", "base sphere 0 0 0 x", "base cone 0 0 0 1 1",
                           "base sphere 0 0 0 1 2", "base sphere 0 0 0 -1", "a sphere 0 0 0 1; base box"})
    expectError([&] { parseBody(text); }, {"masking/body", "FRAME box"});
}

}  // namespace
}  // namespace depth_fusion
