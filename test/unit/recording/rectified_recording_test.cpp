// Recordings whose lens distorts come out as a pinhole camera sees them.
#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/calib3d.hpp>

#include "common/io/text_file.h"
#include "depth_fusion/recording/recording_writer.h"
#include "depth_fusion/registration/registered_recording.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"
#include "support/test_compute.h"

namespace depth_fusion {
namespace {

constexpr CameraIntrinsics kCamera{320, 240, 258.65, 258.25, 159.05, 127.4};
const std::vector<double> kDistortion = {0.2624, -0.9531, -0.0054, 0.0026, 1.1633};

cv::Matx33d cameraMatrix() {
  return {kCamera.fx, 0.0, kCamera.cx, 0.0, kCamera.fy, kCamera.cy, 0.0, 0.0, 1.0};
}

// A plane askew before a pinhole camera, its colour the square of a checkerboard.
float depthAt(const cv::Point2d& ray) { return static_cast<float>(1.0 / (0.6 + 0.25 * ray.x - 0.2 * ray.y)); }
uchar brightnessAt(const cv::Point2d& ray) {
  return static_cast<uchar>(128.0 + 100.0 * std::sin(9.0 * ray.x) * std::cos(7.0 * ray.y));
}

RgbdFrame frameOf(bool distorted) {
  RgbdFrame frame;
  frame.stamp_s = 1.0;
  frame.intrinsics = kCamera;
  frame.depth_unit_m = 0.0002;
  frame.depth = cv::Mat(kCamera.height, kCamera.width, CV_16UC1);
  frame.color = cv::Mat(kCamera.height, kCamera.width, CV_8UC3);
  std::vector<cv::Point2d> pixels, rays;
  for (int v = 0; v < kCamera.height; ++v) {
    for (int u = 0; u < kCamera.width; ++u) pixels.emplace_back(u, v);
  }
  cv::undistortPoints(pixels, rays, cameraMatrix(), distorted ? cv::Mat(kDistortion) : cv::Mat());
  for (size_t i = 0; i < pixels.size(); ++i) {
    frame.depth.at<uint16_t>(pixels[i]) =
        static_cast<uint16_t>(std::lround(depthAt(rays[i]) / frame.depth_unit_m));
    frame.color.at<cv::Vec3b>(pixels[i]) = cv::Vec3b::all(brightnessAt(rays[i]));
  }
  return frame;
}

std::string writeRecording(const TemporaryFolder& folder, const RgbdFrame& frame) {
  const auto writer = createTumFolder(folder / "recording");
  writer->write(frame);
  writer->finish();
  return folder / "recording";
}

std::string calibrationText(const std::string& model) {
  return "image_width: 320\nimage_height: 240\ncamera_name: test\ncamera_matrix:\n  rows: 3\n  cols: 3\n"
         "  data: [258.65, 0.0, 159.05, 0.0, 258.25, 127.4, 0.0, 0.0, 1.0]\ndistortion_model: " +
         model +
         "\ndistortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [0.2624, -0.9531, -0.0054, 0.0026, "
         "1.1633]\n";
}

std::unique_ptr<Recording> openRegistered(const std::string& path, const RecordingOptions& options) {
  return registered(openFolder(path, options), compute(), {});
}

struct Difference {
  double depth_m, brightness;
};

// Means over the middle of the image, which both see.
Difference meanDifference(const RgbdFrame& a, const RgbdFrame& b) {
  const cv::Rect middle(20, 20, kCamera.width - 40, kCamera.height - 40);
  cv::Mat depth_a, depth_b;  // metres
  a.depth(middle).convertTo(depth_a, CV_32F, a.depth_unit_m);
  b.depth(middle).convertTo(depth_b, CV_32F, b.depth_unit_m);
  return {cv::norm(depth_a, depth_b, cv::NORM_L1) / middle.area(),
          cv::norm(a.color(middle), b.color(middle), cv::NORM_L1) / middle.area() / 3.0};
}

TEST(RectifiedRecording, ShowsWhatAPinholeCameraSees) {
  const TemporaryFolder folder;
  const std::string path = writeRecording(folder, frameOf(true));
  writeText(folder / "camera.yaml", calibrationText("plumb_bob"));
  RecordingOptions options;
  const Difference raw = meanDifference(*openFolder(path, options)->next(), frameOf(false));
  readCamera(folder / "camera.yaml", options);
  const auto recording = openRegistered(path, options);
  const Difference rectified = meanDifference(*recording->next(), frameOf(false));
  EXPECT_LT(rectified.depth_m, 0.25 * raw.depth_m) << "the nearest pixel's";
  EXPECT_LT(rectified.brightness, 0.15 * raw.brightness);
  EXPECT_LT(rectified.depth_m, 0.001);
  EXPECT_FALSE(recording->next().has_value());
}

TEST(RectifiedRecording, ARecordingsOwnCalibrationCounts) {
  const TemporaryFolder folder;
  const std::string path = writeRecording(folder, frameOf(true));
  writeText(path + "/camera.yaml", calibrationText("plumb_bob"));
  EXPECT_LT(meanDifference(*openRegistered(path, {})->next(), frameOf(false)).depth_m, 0.001);
}

TEST(RectifiedRecording, AGivenCameraFilesDepthScaleCounts) {
  const TemporaryFolder folder;
  const std::string path = writeRecording(folder, frameOf(false));
  const std::string camera = "width: 320\nheight: 240\nfx: 258.65\nfy: 258.25\ncx: 159.05\ncy: 127.4\n";
  for (const std::string& text : {camera, calibrationText("plumb_bob")}) {
    RecordingOptions options;
    writeText(folder / "camera.yaml", text + "depth_scale: 1000\n");
    readCamera(folder / "camera.yaml", options);
    EXPECT_DOUBLE_EQ(openFolder(path, options)->next()->depth_unit_m, 0.001);
    writeText(folder / "camera.yaml", text);
    RecordingOptions without_scale;
    readCamera(folder / "camera.yaml", without_scale);
    EXPECT_DOUBLE_EQ(openFolder(path, without_scale)->next()->depth_unit_m, 0.0002) << "the recording's own";
  }
}

TEST(RectifiedRecording, WrongCalibrationsAreNamed) {
  const TemporaryFolder folder;
  const std::string path = writeRecording(folder, frameOf(true));
  writeText(path + "/camera.yaml", calibrationText("equidistant"));
  expectError([&] { openFolder(path, {}); }, {"camera.yaml", "equidistant", "plumb_bob"});
  writeText(path + "/camera.yaml", "width: 320\nheight: 240\nfx: 1\nfy: 1\ncx: 1\ncy: 1\n");
  RecordingOptions options;
  options.intrinsics = kCamera;
  options.distortion = {0.1, 0.2, 0.3};
  expectError([&] { openFolder(path, options); }, {"4, 5 or 8 coefficients", "not 3"});
}

TEST(RectifiedRecording, AColorCameraMayStandBesideTheDepthCamera) {
  const TemporaryFolder folder;
  const std::string path = writeRecording(folder, frameOf(false));
  const std::string matrix = "depth_to_color:\n  rows: 4\n  cols: 4\n  data: [1, 0, 0, ";
  writeText(folder / "color.yaml",
            calibrationText("plumb_bob") + matrix + "-0.025, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\n");
  RecordingOptions options;
  readColorCamera(folder / "color.yaml", options);
  const auto frame = openFolder(path, options)->next();
  EXPECT_TRUE(frame->distortion.empty());
  EXPECT_EQ(frame->color_distortion, kDistortion);
  EXPECT_TRUE(frame->T_C_D->isApprox(Pose(Eigen::Translation3d(-0.025, 0.0, 0.0))));
  writeText(folder / "color.yaml",
            calibrationText("plumb_bob") + matrix + "-0.025, 0, 2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\n");
  expectError([&] { readColorCamera(folder / "color.yaml", options); },
              {"color.yaml", "depth_to_color", "no rigid motion"});
}

}  // namespace
}  // namespace depth_fusion
