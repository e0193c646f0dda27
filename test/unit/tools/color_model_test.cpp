// Colour as a real camera gives it.
#include "tools/simulation/color_model.h"

#include <gtest/gtest.h>

#include <cmath>

namespace depth_fusion {
namespace {

const CameraIntrinsics kCamera{160, 120, 130.0, 130.0, 79.5, 59.5};

// A wall at 2 m of one level, or with a bright column.
RenderedView wall(double level) {
  RenderedView view;
  view.depth_m = cv::Mat(120, 160, CV_32FC1, cv::Scalar(2.0));
  view.color = cv::Mat(120, 160, CV_8UC3, cv::Scalar::all(level));
  return view;
}

void meanAndSigma(const cv::Mat& image, double& mean, double& sigma) {
  cv::Scalar means, sigmas;
  cv::meanStdDev(image, means, sigmas);
  mean = means[0];
  sigma = sigmas[0];
}

TEST(ColorModel, LeavesTheImageAloneUnlessTold) {
  const RenderedView view = wall(90);
  EXPECT_EQ(cv::norm(senseColor(view, {}, kCamera, {}, 1), view.color, cv::NORM_INF), 0.0);
}

TEST(ColorModel, NoiseGrowsWithTheLight) {
  ColorModel model;
  model.read_sigma = 2.0;
  model.shot_gain = 0.08;
  for (const double level : {20.0, 100.0, 180.0}) {
    double mean = 0.0, sigma = 0.0;
    meanAndSigma(senseColor(wall(level), model, kCamera, {}, 1), mean, sigma);
    EXPECT_NEAR(mean, level, 0.2);
    EXPECT_NEAR(sigma, std::sqrt(4.0 + 0.08 * level + 1.0 / 12.0), 0.1);
  }
  const cv::Mat once = senseColor(wall(90), model, kCamera, {}, 1);
  EXPECT_EQ(cv::norm(once, senseColor(wall(90), model, kCamera, {}, 1), cv::NORM_INF), 0.0);
  EXPECT_GT(cv::norm(once, senseColor(wall(90), model, kCamera, {}, 2), cv::NORM_INF), 0.0);
}

TEST(ColorModel, ExposureBringsTheMeanToItsTargetWithinAFactorOfFour) {
  ColorModel model;
  model.target_level = 110.0;
  const auto exposed = [&](double level) {
    double mean = 0.0, sigma = 0.0;
    meanAndSigma(senseColor(wall(level), model, kCamera, {}, 1), mean, sigma);
    return mean;
  };
  EXPECT_NEAR(exposed(60.0), 110.0, 0.5);
  EXPECT_NEAR(exposed(220.0), 110.0, 0.5);
  EXPECT_NEAR(exposed(10.0), 40.0, 0.5);
  EXPECT_EQ(exposed(0.0), 0.0);
}

TEST(ColorModel, MotionBlursAlongItself) {
  ColorModel model;
  model.exposure_s = 0.02;
  RenderedView view = wall(0);
  view.color.col(80) = cv::Scalar::all(240);
  ExposureMotion sideways;  // by 12 pixels of 2 m / 130
  sideways.T_begin_D.translation().x() = -6.0 * 2.0 / 130.0;
  sideways.T_end_D.translation().x() = 6.0 * 2.0 / 130.0;
  const cv::Mat image = senseColor(view, model, kCamera, sideways, 1);
  for (int u = 76; u <= 84; ++u) EXPECT_NEAR(image.at<cv::Vec3b>(60, u)[0], 240.0 / 13.0, 4.0) << u;
  EXPECT_EQ(image.at<cv::Vec3b>(60, 70)[0], 0);
  ExposureMotion along;
  along.T_begin_D.translation().y() = -6.0 * 2.0 / 130.0;
  EXPECT_EQ(cv::norm(senseColor(view, model, kCamera, along, 1), view.color, cv::NORM_INF), 0.0);
}

}  // namespace
}  // namespace depth_fusion
