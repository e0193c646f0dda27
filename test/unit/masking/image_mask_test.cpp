// What a mask takes out of depth.
#include "depth_fusion/masking/image_mask.h"

#include <gtest/gtest.h>

#include "support/expect_error.h"
#include "tools/simulation/renderer.h"

namespace depth_fusion {
namespace {

constexpr CameraIntrinsics kCamera{160, 120, 130.0, 130.0, 79.5, 59.5};

RgbdFrame flatFrame() {
  RgbdFrame frame;
  frame.intrinsics = kCamera;
  frame.depth = cv::Mat(120, 160, CV_32FC1, cv::Scalar(2.0));
  return frame;
}

TEST(ImageMask, TakesDepthAwayWhereItIsNotZero) {
  for (const int scale : {1, 2}) {  // detectors work on small images
    cv::Mat mask(120 / scale, 160 / scale, CV_8UC1, cv::Scalar(0));
    mask(cv::Rect(40 / scale, 20 / scale, 60 / scale, 80 / scale)).setTo(1);
    RgbdFrame frame = flatFrame();
    const cv::Mat before = frame.depth;
    applyMask(frame, mask, MaskView::kDepth);
    EXPECT_EQ(cv::countNonZero(frame.depth == 0.0f), 60 * 80);
    EXPECT_EQ(cv::countNonZero(frame.depth(cv::Rect(40, 20, 60, 80))), 0);
    EXPECT_EQ(cv::countNonZero(before), 160 * 120) << "somebody else's memory";
    RgbdFrame in_mm = flatFrame();
    in_mm.depth.convertTo(in_mm.depth, CV_16UC1, 1000.0);
    in_mm.depth_unit_m = 0.001;
    applyMask(in_mm, mask, MaskView::kColor);  // registered: both views are one
    EXPECT_EQ(cv::countNonZero(in_mm.depth), 160 * 120 - 60 * 80);
  }
}

// A ball before a wall, masked as the colour camera, which stands beside and sees it elsewhere, shows it.
TEST(ImageMask, OfTheColourCameraIsLookedUpWhereThatSeesThePoint) {
  const Scene scene({room({0.0, 0.0, 0.5}, {4.0, 3.0, 4.0}, {}), sphere({0.1, 0.0, 1.2}, 0.25, {})});
  const Scene wall({room({0.0, 0.0, 0.5}, {4.0, 3.0, 4.0}, {})});
  RgbdFrame frame;
  frame.intrinsics = kCamera;
  frame.color_intrinsics = CameraIntrinsics{320, 240, 270.0, 270.0, 159.5, 119.5};
  Pose T_C_D = Pose::Identity();
  T_C_D.translation() = Eigen::Vector3d(-0.15, 0.0, 0.0);
  frame.T_C_D = T_C_D;
  frame.depth = render(scene, kCamera, Pose::Identity()).depth_m;
  const cv::Mat behind = render(wall, kCamera, Pose::Identity()).depth_m;
  const Pose T_D_C = T_C_D.inverse();
  const cv::Mat seen = render(scene, *frame.color_intrinsics, T_D_C).depth_m;
  const cv::Mat mask = render(wall, *frame.color_intrinsics, T_D_C).depth_m - seen > 0.01;
  const cv::Mat ball = behind - frame.depth > 0.01;
  applyMask(frame, mask, MaskView::kColor);
  const cv::Mat left = ball & (frame.depth > 0.0f);
  EXPECT_GT(cv::countNonZero(ball), 2000);
  EXPECT_LT(cv::countNonZero(left), cv::countNonZero(ball) / 10) << "what the colour camera does not see";
  EXPECT_LT(cv::countNonZero(~ball & (frame.depth == 0.0f)), 1500) << "hidden from the colour camera";
  RgbdFrame wrong = flatFrame();
  wrong.depth = render(scene, kCamera, Pose::Identity()).depth_m;
  applyMask(wrong, mask, MaskView::kDepth);
  EXPECT_GT(cv::countNonZero(ball & (wrong.depth > 0.0f)), cv::countNonZero(ball) / 4);
}

TEST(ImageMask, RefusesWhatIsNone) {
  RgbdFrame frame = flatFrame();
  expectError([&] { applyMask(frame, cv::Mat(120, 160, CV_8UC3), MaskView::kDepth); },
              {"one channel of 8 bits"});
  expectError([&] { applyMask(frame, cv::Mat(), MaskView::kDepth); }, {"one channel of 8 bits"});
  expectError([&] { applyMask(frame, cv::Mat(120, 120, CV_8UC1), MaskView::kDepth); },
              {"120x120", "160x120"});
}

}  // namespace
}  // namespace depth_fusion
