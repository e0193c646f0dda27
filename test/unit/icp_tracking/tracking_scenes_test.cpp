// The scenes that trackers are tried on: what geometry leaves free in them, and what their texture shows.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tools/simulation/simulated_recording.h"

namespace depth_fusion {
namespace {

using Eigen::Vector3d;

constexpr int kFrames[] = {0, 60, 150, 250, 299};
constexpr double kTheta = 0.005;  // the paper's bound of lambda / N between free and fixed

SimulatedRecording recordingOf(const std::string& scene) {
  SimulationOptions options;
  options.scene = scene;
  return SimulatedRecording(options);
}

struct OrientedPoint {
  Vector3d p_W, normal_W;
};

std::vector<OrientedPoint> pointsInRange(const SimulatedScene& scene, const Pose& T_W_D) {
  const CameraIntrinsics camera{160, 120, 131.25, 131.25, 79.5, 59.5};
  const cv::Mat depth_m = idealDepth(render(scene.surface, camera, T_W_D), scene.sensor);
  std::vector<OrientedPoint> points;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const double z_m = depth_m.at<float>(v, u);
      if (z_m == 0.0) continue;
      const Vector3d ray_D((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1.0);
      const Vector3d p_W = T_W_D * (z_m * ray_D);
      const auto& solids = scene.surface.primitives();
      const auto hit = std::min_element(solids.begin(), solids.end(), [&](const auto& a, const auto& b) {
        return std::abs(a.distance(p_W)) < std::abs(b.distance(p_W));
      });
      points.push_back({p_W, hit->normal(p_W)});
    }
  }
  return points;
}

// Eigenvalues, ascending, of the point-to-plane system per point, with the points shrunk to the unit cube.
Vector6d systemEigenvalues(const std::vector<OrientedPoint>& points) {
  Vector3d low = points.front().p_W, high = low;
  for (const OrientedPoint& point : points) {
    low = low.cwiseMin(point.p_W);
    high = high.cwiseMax(point.p_W);
  }
  Matrix6d system = Matrix6d::Zero();
  for (const OrientedPoint& point : points) {
    const Vector3d p = (point.p_W - (low + high) / 2.0) / (high - low).maxCoeff();
    Vector6d row;
    row << p.cross(point.normal_W), point.normal_W;
    system += row * row.transpose() / static_cast<double>(points.size());
  }
  return Eigen::SelfAdjointEigenSolver<Matrix6d>(system).eigenvalues();
}

struct FreeDirections {
  const char* scene;
  int count;
};

class FreeDirectionsTest : public testing::TestWithParam<FreeDirections> {};

TEST_P(FreeDirectionsTest, GeometryFixesAllOthers) {
  const SimulatedRecording recording = recordingOf(GetParam().scene);
  for (const int frame : kFrames) {
    const Vector6d eigenvalues =
        systemEigenvalues(pointsInRange(recording.scene(), recording.poseOf(frame).T_W_D));
    for (int i = 0; i < 6; ++i) {
      if (i < GetParam().count) {
        EXPECT_LT(eigenvalues[i], 1e-7) << frame << ": " << eigenvalues.transpose();
      } else {
        EXPECT_GT(eigenvalues[i], kTheta) << frame << ": " << eigenvalues.transpose();
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Library, FreeDirectionsTest,
                         testing::Values(FreeDirections{"wall", 3}, FreeDirections{"floor_wall", 1},
                                         FreeDirections{"cylinder", 1}, FreeDirections{"room", 0},
                                         FreeDirections{"white_room", 0}));

cv::Mat grayOf(const SimulatedRecording& recording, int frame) {
  cv::Mat gray;
  cv::cvtColor(render(recording.scene().surface, recording.intrinsics(), recording.poseOf(frame).T_W_D).color,
               gray, cv::COLOR_BGR2GRAY);
  return gray;
}

// FAST-9: nine neighbours in a row on a circle of 3 px that are all brighter or all darker.
bool isFastCorner(const cv::Mat& gray, const cv::Point& centre) {
  static const cv::Point kCircle[16] = {{0, -3}, {1, -3},  {2, -2},  {3, -1}, {3, 0},  {3, 1},
                                        {2, 2},  {1, 3},   {0, 3},   {-1, 3}, {-2, 2}, {-3, 1},
                                        {-3, 0}, {-3, -1}, {-2, -2}, {-1, -3}};
  constexpr int kThreshold = 20;
  int run = 0, run_sign = 0;
  for (int i = 0; i < 16 + 8; ++i) {
    const int step = gray.at<uchar>(centre + kCircle[i % 16]) - gray.at<uchar>(centre);
    const int sign = step > kThreshold ? 1 : step < -kThreshold ? -1 : 0;
    run = sign == run_sign ? run + 1 : 1;
    run_sign = sign;
    if (sign != 0 && run >= 9) return true;
  }
  return false;
}

// How many FAST corners each 80 x 80 px cell of an image holds, from the poorest cell to the richest.
std::vector<int> cornersPerCell(const cv::Mat& gray) {
  constexpr int kCell_px = 80, kBorder_px = 3;
  std::vector<int> counts((gray.rows / kCell_px) * (gray.cols / kCell_px), 0);
  for (int v = kBorder_px; v < gray.rows - kBorder_px; ++v) {
    for (int u = kBorder_px; u < gray.cols - kBorder_px; ++u) {
      counts[v / kCell_px * (gray.cols / kCell_px) + u / kCell_px] += isFastCorner(gray, {u, v}) ? 1 : 0;
    }
  }
  std::sort(counts.begin(), counts.end());
  return counts;
}

class TexturedSceneTest : public testing::TestWithParam<std::string> {};

TEST_P(TexturedSceneTest, HasCornersEverywhere) {
  const SimulatedRecording recording = recordingOf(GetParam());
  for (const int frame : kFrames) {
    EXPECT_GE(cornersPerCell(grayOf(recording, frame)).front(), 20) << frame;
  }
}

// No patch of an image looks like another part of the image.
TEST_P(TexturedSceneTest, HasNoTwoPlacesAlike) {
  const cv::Mat gray = grayOf(recordingOf(GetParam()), 150);
  constexpr int kPatch_px = 31;
  for (int v = 20; v < gray.rows - kPatch_px; v += 100) {
    for (int u = 20; u < gray.cols - kPatch_px; u += 100) {
      cv::Mat likeness;
      cv::matchTemplate(gray, gray(cv::Rect(u, v, kPatch_px, kPatch_px)), likeness, cv::TM_CCOEFF_NORMED);
      EXPECT_NEAR(likeness.at<float>(v, u), 1.0, 1e-3);
      cv::rectangle(likeness, cv::Rect(u - 15, v - 15, 31, 31), -1.0, cv::FILLED);
      double most_like = 0.0;
      cv::minMaxLoc(likeness, nullptr, &most_like);
      EXPECT_LT(most_like, 0.85) << u << " " << v;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Library, TexturedSceneTest, testing::Values("wall", "floor_wall", "cylinder"));

TEST(WhiteRoom, ShowsNoCorners) {
  const SimulatedRecording recording = recordingOf("white_room");
  for (const int frame : kFrames) EXPECT_EQ(cornersPerCell(grayOf(recording, frame)).back(), 0) << frame;
}

TEST(WhiteRoom, HasTheRoomsGeometry) {
  const SimulatedRecording white = recordingOf("white_room"), room = recordingOf("room");
  const CameraIntrinsics camera{160, 120, 131.25, 131.25, 79.5, 59.5};
  for (const int frame : kFrames) {
    const Pose T_W_D = room.poseOf(frame).T_W_D;
    EXPECT_TRUE(T_W_D.isApprox(white.poseOf(frame).T_W_D, 0.0));
    EXPECT_EQ(cv::norm(render(white.scene().surface, camera, T_W_D).depth_m,
                       render(room.scene().surface, camera, T_W_D).depth_m, cv::NORM_INF),
              0.0);
  }
}

}  // namespace
}  // namespace depth_fusion
