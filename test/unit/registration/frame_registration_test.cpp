// Frames as sensors give them, rectified and registered: against a plain reference, and against scenes
// rendered from where the other camera stands.
#include "depth_fusion/registration/frame_registration.h"

#include <gtest/gtest.h>

#include "depth_fusion/compute/device_image.h"
#include "reference/registration.h"
#include "support/distorted_view.h"
#include "support/expect_error.h"
#include "support/simulated_frames.h"
#include "support/test_compute.h"

namespace depth_fusion {
namespace {

constexpr CameraIntrinsics kDepthCamera{161, 122, 146.0, 147.0, 79.0, 61.5};
constexpr CameraIntrinsics kColorCamera{203, 151, 190.0, 189.0, 103.0, 74.0};
const Pose kBeside = motionOf({0.4, -0.6, 0.5}, {-0.025, 0.002, -0.004});
const LensDistortion kPlumbBob = {0.12, -0.25, 0.002, -0.003, 0.1};
const LensDistortion kRational = {0.3, -0.1, 0.001, 0.001, 0.02, 0.35, -0.08, 0.03};

// A wall that leans, and a box and a ball before it.
const Scene& smallScene() {
  const Material material{Eigen::Vector3d::Constant(150.0), Pattern::kSpeckles, 0.2, 0.3, false};
  static const Scene scene({plane({0.0, 0.0, 2.0}, {0.3, 0.1, -1.0}, material),
                            box({0.1, 0.0, 1.2}, {0.4, 0.35, 0.1}, material, 0.4),
                            sphere({-0.3, 0.15, 1.0}, 0.12, material)});
  return scene;
}

RgbdFrame frameOfView(const RenderedView& view, const CameraIntrinsics& camera) {
  RgbdFrame frame;
  frame.depth = view.depth_m;
  frame.color = view.color;
  frame.intrinsics = camera;
  return frame;
}

// Depth by itself, colour by the camera beside it.
RgbdFrame unregisteredFrame() {
  RgbdFrame frame = frameOfView(render(smallScene(), kDepthCamera, Pose::Identity()), kDepthCamera);
  frame.color = render(smallScene(), kColorCamera, kBeside.inverse()).color;
  frame.color_intrinsics = kColorCamera;
  frame.T_C_D = kBeside;
  return frame;
}

RegistrationParameters toColor() {
  RegistrationParameters parameters;
  parameters.depth_to_color = true;
  return parameters;
}

RgbdFrame process(const RgbdFrame& frame, const RegistrationParameters& parameters = {}) {
  return FrameRegistration(compute(), parameters).process(frame);
}

// Where two depth images differ: the part of pixels that only one of them has, the part of the others that
// are more than 1 % apart, as at edges, and the mean difference of the rest.
struct Difference {
  double only_one, far, mean_m;
};

Difference compare(const cv::Mat& a, const cv::Mat& b) {
  const cv::Mat both = (a > 0.0f) & (b > 0.0f);
  cv::Mat apart;
  cv::absdiff(a, b, apart);
  const double count = cv::countNonZero(both);
  const cv::Mat far = (apart > 0.01f * b) & both;
  return {cv::countNonZero((a > 0.0f) != (b > 0.0f)) / static_cast<double>(a.total()),
          cv::countNonZero(far) / count, cv::mean(apart, both & ~far)[0]};
}

class AgainstReference : public testing::TestWithParam<LensDistortion> {};

TEST_P(AgainstReference, Rectified) {
  RgbdFrame frame = unregisteredFrame();
  frame.depth(cv::Rect(30, 20, 9, 7)).setTo(0.0f);
  frame.distortion = GetParam();
  const reference::DepthCamera camera(frame.depth, kDepthCamera, frame.distortion, 0.03);
  const Difference difference =
      compare(process(frame).depth, reference::rectifiedDepth(camera, kDepthCamera));
  EXPECT_LT(difference.only_one, 0.001);
  EXPECT_LT(difference.mean_m, 1e-5);
  EXPECT_LT(difference.far, 0.001);
}

TEST_P(AgainstReference, Registered) {
  RgbdFrame frame = unregisteredFrame();
  frame.depth(cv::Rect(30, 20, 9, 7)).setTo(0.0f);
  frame.distortion = GetParam();
  const reference::DepthCamera camera(frame.depth, kDepthCamera, frame.distortion, 0.03);
  const cv::Mat rectified = reference::rectifiedDepth(camera, kDepthCamera);
  const cv::Mat nearest = reference::nearestDepth(rectified, kDepthCamera, kColorCamera, kBeside, 1);
  const cv::Mat expected = reference::registeredDepth(camera, nearest, kColorCamera, kBeside, 0.03);
  ASSERT_GT(cv::countNonZero(expected), 0.8 * expected.total());
  const Difference difference = compare(process(frame, toColor()).depth, expected);
  EXPECT_LT(difference.only_one, 0.002);
  EXPECT_LT(difference.mean_m, 1e-4);
  EXPECT_LT(difference.far, 0.002);
}

INSTANTIATE_TEST_SUITE_P(Lenses, AgainstReference, testing::Values(LensDistortion{}, kPlumbBob, kRational));

// What the colour camera would measure, away from the edges of things.
TEST(FrameRegistration, IsWhatTheOtherCameraSees) {
  const RgbdFrame frame = unregisteredFrame();
  const RgbdFrame registered = process(frame, toColor());
  const RenderedView truth = render(smallScene(), kColorCamera, kBeside.inverse());
  ASSERT_TRUE(sameCamera(registered.intrinsics, kColorCamera));
  EXPECT_FALSE(registered.T_C_D.has_value());
  EXPECT_FALSE(registered.color_intrinsics.has_value());
  const Difference difference = compare(registered.depth, truth.depth_m);
  EXPECT_LT(difference.mean_m, 5e-4);
  EXPECT_LT(difference.far, 0.01) << "the wall shows through the box, or the box where the wall is";
  EXPECT_LT(difference.only_one, 0.12) << "beyond the depth camera's view, and hidden from it";
  const RgbdFrame unmoved = process(frame);
  EXPECT_EQ(unmoved.depth.data, frame.depth.data) << "left where it is";
  EXPECT_TRUE(unmoved.T_C_D->isApprox(kBeside));
}

// Averaging what is measured neither nears nor roughens it, as taking the nearest of several pixels would.
TEST(FrameRegistration, KeepsNoiseUnbiased) {
  const double sigma_m = 0.005;
  RgbdFrame frame = unregisteredFrame();
  frame.depth.setTo(1.5f);
  cv::Mat noise(frame.depth.size(), CV_32FC1);
  cv::RNG(7).fill(noise, cv::RNG::NORMAL, 0.0, sigma_m);
  frame.depth += noise;
  frame.T_C_D = Pose(Eigen::Translation3d(-0.025, 0.0, 0.0));
  const cv::Mat depth = process(frame, toColor()).depth;
  cv::Scalar mean, deviation;
  cv::meanStdDev(depth, mean, deviation, depth > 0.0f);
  EXPECT_NEAR(mean[0], 1.5, 0.05 * sigma_m);
  EXPECT_LT(deviation[0], sigma_m);
}

// Upsampled by 1.4 and downsampled by 2: no pixel of a wall is left out.
TEST(FrameRegistration, LeavesNoHoles) {
  for (const double factor : {1.4, 0.5}) {
    RgbdFrame frame = unregisteredFrame();
    frame.depth.setTo(1.5f);
    CameraIntrinsics camera = kDepthCamera;
    camera.width = static_cast<int>(factor * camera.width);
    camera.height = static_cast<int>(factor * camera.height);
    for (double* value : {&camera.fx, &camera.fy, &camera.cx, &camera.cy}) *value *= factor;
    frame.color_intrinsics = camera;
    frame.color.release();
    const cv::Mat depth = process(frame, toColor()).depth;
    ASSERT_EQ(depth.cols, camera.width);
    const cv::Rect middle(camera.width / 10, camera.height / 10, camera.width * 8 / 10,
                          camera.height * 8 / 10);
    EXPECT_EQ(cv::countNonZero(depth(middle) == 0.0f), 0) << factor;
  }
}

TEST(FrameRegistration, FineColorCamerasAreHalved) {
  const CameraIntrinsics hd{1920, 1080, 1050.0, 1050.0, 959.5, 539.5};
  const CameraIntrinsics registered = registeredCamera(hd, {640, 480, 575.0, 575.0, 319.5, 239.5});
  EXPECT_EQ(registered.width, 960);
  EXPECT_DOUBLE_EQ(registered.fx, 525.0);
  EXPECT_TRUE(sameCamera(registeredCamera(kColorCamera, kDepthCamera), kColorCamera));
}

// A scene through a lens comes out as without one.
TEST(FrameRegistration, TakesOutTheLens) {
  for (const LensDistortion& lens : {kPlumbBob, kRational}) {
    const RenderedView view = distortedView(smallScene(), kDepthCamera, lens, Pose::Identity());
    const RgbdFrame truth = frameOfView(render(smallScene(), kDepthCamera, Pose::Identity()), kDepthCamera);
    RgbdFrame frame = frameOfView(view, kDepthCamera);
    frame.distortion = frame.color_distortion = lens;
    const RgbdFrame rectified = process(frame);
    EXPECT_TRUE(rectified.distortion.empty() && rectified.color_distortion.empty());
    const Difference before = compare(frame.depth, truth.depth),
                     after = compare(rectified.depth, truth.depth);
    EXPECT_LT(after.mean_m, 0.25 * before.mean_m);
    EXPECT_LT(after.far, 0.01);
  }
}

TEST(FrameRegistration, DoesNothingWhereNothingIsToBeDone) {
  RgbdFrame frame = frameOfView(render(smallScene(), kDepthCamera, Pose::Identity()), kDepthCamera);
  frame.distortion = frame.color_distortion = {0.0, 0.0, 0.0, 0.0, 0.0};
  for (const RegistrationParameters& parameters : {RegistrationParameters(), toColor()}) {
    EXPECT_FALSE(needsRegistration(frame, parameters));
    const RgbdFrame same = process(frame, parameters);
    EXPECT_EQ(same.depth.data, frame.depth.data);
    EXPECT_EQ(same.color.data, frame.color.data);
    EXPECT_EQ(same.depth_unit_m, frame.depth_unit_m);
  }
}

TEST(FrameRegistration, UnitsAndScaleAreParameters) {
  RgbdFrame frame = frameOfView(render(smallScene(), kDepthCamera, Pose::Identity()), kDepthCamera);
  frame.depth.convertTo(frame.depth, CV_16U, 1e4);
  frame.depth_unit_m = 0.001;
  RegistrationParameters parameters;
  parameters.depth_unit_m = 1e-4f;
  parameters.depth_scale = 1.02f;
  const RgbdFrame scaled = process(frame, parameters);
  EXPECT_NEAR(scaled.depth_unit_m, 1.02e-4, 1e-10);
  EXPECT_EQ(scaled.depth.data, frame.depth.data);
  frame.distortion = kPlumbBob;
  const RgbdFrame rectified = process(frame, parameters);
  EXPECT_NEAR(rectified.depth.at<float>(61, 79), 1.02e-4 * frame.depth.at<uint16_t>(61, 79), 2e-3);
}

TEST(FrameRegistration, PosesMoveWithTheDepth) {
  RgbdFrame frame = unregisteredFrame();
  frame.T_W_D = motionOf({10.0, 20.0, 30.0}, {1.0, 2.0, 3.0});
  EXPECT_TRUE(process(frame, toColor()).T_W_D->isApprox(*frame.T_W_D * kBeside.inverse()));
}

TEST(FrameRegistration, ColourThatCannotBeRectifiedCostsNoDepth) {
  for (const auto& [lens, word] :
       {std::make_pair(LensDistortion{-1.2, 0.0, 0.0, 0.0}, "folds"),
        std::make_pair(LensDistortion{0.1, 0.2, 0.3}, "not 3"),
        std::make_pair(LensDistortion{0.1, std::nan(""), 0.0, 0.0}, "no number")}) {
    RgbdFrame frame = unregisteredFrame();
    frame.color_distortion = lens;
    const RgbdFrame result = process(frame);
    EXPECT_FALSE(result.depth.empty());
    EXPECT_TRUE(result.color.empty());
    EXPECT_NE(result.color_problem.find(word), std::string::npos) << result.color_problem;
  }
}

TEST(FrameRegistration, ThinPrismAndTiltAreTakenOutOfColour) {
  RgbdFrame frame = unregisteredFrame();
  frame.color_distortion = {0.1, -0.05, 0.001, 0.001, 0.0, 0.0, 0.0, 0.0, 0.02, 0.0, 0.0, 0.0, 0.01, 0.01};
  const RgbdFrame tilted = process(frame);
  EXPECT_EQ(tilted.color_problem, "");
  frame.color_distortion.resize(8);
  EXPECT_GT(cv::norm(tilted.color, process(frame).color, cv::NORM_L1), 0.0);
}

TEST(FrameRegistration, RefusesWhatCannotBeUndone) {
  RgbdFrame frame = unregisteredFrame();
  frame.distortion = {-1.2, 0.0, 0.0, 0.0};
  expectError([&] { process(frame); }, {"the depth camera", "folds the image", "calibrate"});
  frame.distortion = {0.1, 0.2, 0.3};
  expectError([&] { process(frame); }, {"4, 5 or 8 coefficients", "not 3"});
  frame.distortion = {0.1, std::nan(""), 0.0, 0.0};
  expectError([&] { process(frame); }, {"no number"});
  frame.distortion = kPlumbBob;
  frame.intrinsics.width += 1;
  expectError([&] { process(frame); }, {"161x122", "162x122"});
  frame = unregisteredFrame();
  frame.distortion = LensDistortion(14, 0.01);
  expectError([&] { process(frame); }, {"the depth camera", "thin prism", "rectified"});
  frame = unregisteredFrame();
  frame.weights = cv::Mat(frame.depth.size(), CV_32FC1, cv::Scalar(1.0));
  expectError([&] { process(frame, toColor()); }, {"weights"});
}

}  // namespace
}  // namespace depth_fusion
