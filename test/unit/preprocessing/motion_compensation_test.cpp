// Depth of a moving rolling shutter becomes depth of the moment of the stamp.
#include <gtest/gtest.h>

#include "depth_fusion/compute/device_image.h"
#include "depth_fusion/preprocessing/depth_preprocessor.h"
#include "support/test_compute.h"
#include "tools/simulation/renderer.h"
#include "tools/simulation/scene_library.h"
#include "tools/simulation/simulated_recording.h"

namespace depth_fusion {
namespace {

constexpr CameraIntrinsics kCamera{640, 480, 525.0, 525.0, 319.5, 239.5};
constexpr float kReadout_s = 0.03f;
constexpr float kDelay_s = 0.01f;

// Rotating by 60 deg/s while moving at half a metre a second.
Vector6d fastHand() {
  Vector6d velocity;
  velocity << 0.6, -0.7, 0.5, 0.3, -0.2, 0.35;
  return velocity;
}

Pose startPose() { return SimulatedRecording(SimulationOptions()).poseOf(0).T_W_D; }

// What the room looks like to a sensor that moves with `velocity` and reads row after row, ending kDelay_s
// before it is at the start pose.
cv::Mat rollingDepth(const Vector6d& velocity) {
  static const SimulatedScene scene = makeScene("room");
  cv::Mat depth(kCamera.height, kCamera.width, CV_32FC1);
  for (int v = 0; v < kCamera.height; ++v) {
    const double time_s = kReadout_s * ((v + 0.5) / kCamera.height - 1.0) - kDelay_s;
    CameraIntrinsics row = kCamera;
    row.height = 1;
    row.cy -= v;
    render(scene.surface, row, startPose() * poseFromTwist(time_s * velocity)).depth_m.copyTo(depth.row(v));
  }
  return depth;
}

cv::Mat stillDepth() {
  static const SimulatedScene scene = makeScene("room");
  return render(scene.surface, kCamera, startPose()).depth_m;
}

cv::Mat compensated(const cv::Mat& depth, const Vector6d& velocity, float readout_s, float delay_s) {
  PreprocessingParameters parameters;
  parameters.readout_s = readout_s;
  parameters.stamp_delay_s = delay_s;
  DepthPreprocessor preprocessor(compute(), parameters, kCamera);
  RgbdFrame frame;
  frame.depth = depth;
  return readImage(preprocessor.process(frame, velocity).raw_depth, kCamera);
}

// The median over the pixels with depth in both, away from the furniture's edges.
double medianDifference_m(const cv::Mat& a, const cv::Mat& b) {
  std::vector<float> differences;
  for (int v = 0; v < a.rows; ++v) {
    for (int u = 0; u < a.cols; ++u) {
      if (a.at<float>(v, u) > 0 && b.at<float>(v, u) > 0) {
        differences.push_back(std::abs(a.at<float>(v, u) - b.at<float>(v, u)));
      }
    }
  }
  EXPECT_GT(differences.size(), 0.9 * a.total());
  std::nth_element(differences.begin(), differences.begin() + differences.size() / 2, differences.end());
  return differences[differences.size() / 2];
}

TEST(MotionCompensation, MovesEachRowToTheStamp) {
  const cv::Mat rolling = rollingDepth(fastHand());
  const double before_m = medianDifference_m(rolling, stillDepth());
  EXPECT_GT(before_m, 0.008) << "this motion is to be seen";
  EXPECT_LT(medianDifference_m(compensated(rolling, fastHand(), kReadout_s, kDelay_s), stillDepth()), 0.0015);
  EXPECT_GT(medianDifference_m(compensated(rolling, fastHand(), kReadout_s, 0.0f), stillDepth()), 0.002)
      << "without the delay it is compensated to another moment";
  EXPECT_GT(medianDifference_m(compensated(rolling, -fastHand(), kReadout_s, kDelay_s), stillDepth()),
            before_m);
}

TEST(MotionCompensation, LeavesTheDepthOfGlobalShuttersAndStillSensors) {
  const cv::Mat depth = stillDepth();
  EXPECT_EQ(cv::norm(compensated(depth, fastHand(), 0.0f, 0.0f), depth, cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(compensated(depth, Vector6d::Zero(), kReadout_s, kDelay_s), depth, cv::NORM_INF), 0.0);
}

TEST(MotionCompensation, KeepsHolesAndBringsInNothingFromBesideTheImage) {
  cv::Mat depth(kCamera.height, kCamera.width, CV_32FC1, cv::Scalar(1.0));
  depth(cv::Rect(100, 70, 50, 40)).setTo(0.0);
  Vector6d velocity = Vector6d::Zero();
  velocity[3] = 4.0;  // 40 mm to the right in kDelay_s: 21 pixels
  const cv::Mat result = compensated(depth, velocity, 0.0f, kDelay_s);
  EXPECT_EQ(cv::countNonZero(result(cv::Rect(121, 70, 8, 40))), 0);
  EXPECT_EQ(cv::countNonZero(result(cv::Rect(0, 0, 21, kCamera.height))) +
                cv::countNonZero(result(cv::Rect(kCamera.width - 21, 0, 21, kCamera.height))),
            21 * kCamera.height);
  double smallest = 0.0, largest = 0.0;
  cv::minMaxLoc(result, &smallest, &largest);
  EXPECT_FLOAT_EQ(static_cast<float>(largest), 1.0f);
}

}  // namespace
}  // namespace depth_fusion
