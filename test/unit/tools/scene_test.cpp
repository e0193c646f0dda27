// Scenes, their images, paths and sensors.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <opencv2/core.hpp>
#include <random>

#include "depth_fusion/common/error.h"
#include "tools/simulation/simulated_recording.h"

namespace depth_fusion {
namespace {

using Eigen::Vector3d;

constexpr double kPi = 3.141592653589793;

Vector3d randomIn(std::mt19937& random, const Vector3d& low, const Vector3d& high) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const Vector3d fraction(uniform(random), uniform(random), uniform(random));
  return low + fraction.cwiseProduct(high - low);
}

// The distance from p to a surface given by points that lie at most spacing_m apart.
double bruteForce(const std::vector<Vector3d>& surface, const Vector3d& p) {
  double nearest = 1e9;
  for (const Vector3d& point : surface) nearest = std::min(nearest, (point - p).norm());
  return nearest;
}

void expectDistance(const Primitive& solid, const std::vector<Vector3d>& surface, double spacing_m) {
  std::mt19937 random(3);
  for (int i = 0; i < 300; ++i) {
    const Vector3d p = randomIn(random, Vector3d::Constant(-1.0), Vector3d::Constant(1.0));
    const double nearest = bruteForce(surface, p);
    EXPECT_NEAR(std::abs(solid.distance(p)), nearest, spacing_m * spacing_m / (2.0 * nearest) + 1e-9)
        << p.transpose();
  }
}

TEST(Primitive, BoxAgreesWithPointsOnItsFaces) {
  const Vector3d half(0.3, 0.2, 0.4), centre(0.1, -0.2, 0.05);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.6, Vector3d::UnitZ()).toRotationMatrix();
  std::vector<Vector3d> surface;
  constexpr int kSteps = 60;
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i <= kSteps; ++i) {
      for (int j = 0; j <= kSteps; ++j) {
        for (const double side : {-1.0, 1.0}) {
          Vector3d p;
          p[axis] = side;
          p[(axis + 1) % 3] = 2.0 * i / kSteps - 1.0;
          p[(axis + 2) % 3] = 2.0 * j / kSteps - 1.0;
          surface.push_back(centre + turn * p.cwiseProduct(half));
        }
      }
    }
  }
  expectDistance(box(centre, 2.0 * half, {}, 0.6), surface, 0.8 / kSteps);
}

TEST(Primitive, CylinderAgreesWithPointsOnIt) {
  const Vector3d bottom(0.1, -0.2, -0.3), top(0.1, -0.2, 0.4);
  constexpr double kRadius_m = 0.25;
  std::vector<Vector3d> surface;
  constexpr int kSteps = 180;
  for (int i = 0; i < kSteps; ++i) {
    const double angle = 2.0 * kPi * i / kSteps;
    const Vector3d spoke(std::cos(angle), std::sin(angle), 0.0);
    for (int j = 0; j <= 60; ++j) {
      surface.push_back(bottom + j / 60.0 * (top - bottom) + kRadius_m * spoke);
      surface.push_back(bottom + j / 60.0 * kRadius_m * spoke);
      surface.push_back(top + j / 60.0 * kRadius_m * spoke);
    }
  }
  expectDistance(cylinder(bottom, top, kRadius_m, {}), surface, 0.013);
}

TEST(Primitive, RoundShapesHaveTheirAnalyticDistance) {
  const Vector3d a(0.1, 0.2, -0.3), b(0.4, -0.1, 0.2);
  const Primitive ball = sphere(a, 0.3, {});
  const Primitive pill = capsule(a, b, 0.1, {});
  const Primitive wall = plane(a, {1.0, 2.0, 2.0}, {});
  std::mt19937 random(5);
  for (int i = 0; i < 300; ++i) {
    const Vector3d p = randomIn(random, Vector3d::Constant(-1.0), Vector3d::Constant(1.0));
    const double along = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    EXPECT_NEAR(ball.distance(p), (p - a).norm() - 0.3, 1e-12);
    EXPECT_NEAR(pill.distance(p), (p - (a + along * (b - a))).norm() - 0.1, 1e-12);
    EXPECT_NEAR(wall.distance(p), (p - a).dot(Vector3d(1.0, 2.0, 2.0) / 3.0), 1e-12);
  }
}

TEST(Primitive, TorusAgreesWithPointsOnIt) {
  const Vector3d centre(0.1, -0.2, 0.05), axis = Vector3d(1.0, 2.0, 2.0) / 3.0;
  const Vector3d across = axis.unitOrthogonal();
  constexpr double kRadius_m = 0.4, kTube_m = 0.1;
  std::vector<Vector3d> surface;
  constexpr int kSteps = 300;
  for (int i = 0; i < kSteps; ++i) {
    const Vector3d spoke = Eigen::AngleAxisd(2.0 * kPi * i / kSteps, axis) * across;
    for (int j = 0; j < kSteps / 4; ++j) {
      const double angle = 8.0 * kPi * j / kSteps;
      surface.push_back(centre + (kRadius_m + kTube_m * std::cos(angle)) * spoke +
                        kTube_m * std::sin(angle) * axis);
    }
  }
  expectDistance(torus(centre, axis, kRadius_m, kTube_m, {}), surface, 0.02);
}

TEST(Primitive, RoundedBoxIsASmallerBoxGrown) {
  const Primitive rounded = box({0, 0, 0}, {0.6, 0.4, 0.8}, {}, 0.3, 0.05);
  const Primitive core = box({0, 0, 0}, {0.5, 0.3, 0.7}, {}, 0.3);
  std::mt19937 random(6);
  for (int i = 0; i < 100; ++i) {
    const Vector3d p = randomIn(random, Vector3d::Constant(-1.0), Vector3d::Constant(1.0));
    EXPECT_NEAR(rounded.distance(p), core.distance(p) - 0.05, 1e-12);
  }
}

TEST(Primitive, RoomIsPositiveInside) {
  const Primitive shell = room({0, 0, 1}, {4, 3, 2}, {});
  EXPECT_NEAR(shell.distance({1.7, 0, 1}), 0.3, 1e-12);
  EXPECT_NEAR(shell.distance({0, 0, 0.2}), 0.2, 1e-12);
  EXPECT_NEAR(shell.distance({2.3, 1.9, 1}), -0.5, 1e-12);
}

class SceneTest : public testing::TestWithParam<std::string> {
 protected:
  SimulatedRecording recording(bool noise = false, int frames = 3) const {
    SimulationOptions options;
    options.scene = GetParam();
    options.noise = noise;
    options.frames = frames;
    options.intrinsics = halved(halved(makeScene(GetParam()).sensor.camera));
    return SimulatedRecording(options);
  }
};

TEST_P(SceneTest, GradientHasUnitLengthInFreeSpace) {
  const Scene scene = makeScene(GetParam()).surface;
  std::mt19937 random(7);
  int off = 0, tried = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector3d p = randomIn(random, {-1.9, -1.4, 0.0}, {1.9, 1.4, 2.4});
    if (scene.distance(p) < 0.001) continue;
    Vector3d gradient;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d step = 1e-5 * Vector3d::Unit(axis);
      gradient[axis] = (scene.distance(p + step) - scene.distance(p - step)) / 2e-5;
    }
    ++tried;
    if (std::abs(gradient.norm() - 1.0) > 1e-3) ++off;
  }
  EXPECT_GT(tried, 1000);
  EXPECT_LE(off, tried / 200);  // on the edges between the regions of two solids
}

TEST_P(SceneTest, RenderedDepthLiesOnTheSurfaceAndNothingIsInFront) {
  SimulatedRecording simulated = recording();
  const Scene& scene = simulated.scene().surface;
  const CameraIntrinsics& camera = simulated.intrinsics();
  for (int i : {0, 100, 250}) {
    const Pose T_W_D = simulated.poseOf(i).T_W_D;
    const RenderedView view = render(scene, camera, T_W_D);
    int hits = 0;
    for (int v = 0; v < camera.height; ++v) {
      for (int u = 0; u < camera.width; ++u) {
        const double z_m = view.depth_m.at<float>(v, u);
        if (z_m == 0.0) continue;
        ++hits;
        const Vector3d ray_D((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1.0);
        ASSERT_LT(std::abs(scene.distance(T_W_D * (z_m * ray_D))), 5e-5) << u << " " << v;
        for (double before = 0.05; before < 1.0; before += 0.1) {
          ASSERT_GT(scene.distance(T_W_D * (before * z_m * ray_D)), 0.0) << u << " " << v;
        }
      }
    }
    EXPECT_GT(hits, camera.width * camera.height / 10);
  }
}

TEST_P(SceneTest, TheSameSeedGivesTheSameBits) {
  SimulatedRecording first = recording(true), second = recording(true);
  for (int i = 0; i < 3; ++i) {
    const std::optional<RgbdFrame> a = first.next(), b = second.next();
    ASSERT_TRUE(a && b);
    EXPECT_EQ(cv::norm(a->depth, b->depth, cv::NORM_INF), 0.0);
    EXPECT_EQ(cv::norm(a->color, b->color, cv::NORM_INF), 0.0);
    EXPECT_TRUE(a->T_W_D->isApprox(*b->T_W_D, 0.0));
  }
  EXPECT_FALSE(first.next());
}

TEST_P(SceneTest, AnotherSeedOrFrameGivesOtherNoise) {
  SimulatedRecording simulated = recording();
  const SimulatedScene& scene = simulated.scene();
  const RenderedView view = render(scene.surface, simulated.intrinsics(), simulated.poseOf(60).T_W_D);
  EXPECT_GT(cv::norm(senseDepth(view, scene.sensor, 1), senseDepth(view, scene.sensor, 2), cv::NORM_INF),
            0.0);
}

std::vector<std::string> sceneNames() {
  std::vector<std::string> names;
  for (const SceneEntry& scene : sceneLibrary()) names.push_back(scene.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Library, SceneTest, testing::ValuesIn(sceneNames()));

RenderedView wallAt(double z_m) {
  RenderedView view;
  view.depth_m = cv::Mat(480, 640, CV_32FC1, cv::Scalar(z_m));
  view.cos_incidence = cv::Mat(480, 640, CV_32FC1, cv::Scalar(1.0));
  return view;
}

void expectNoise(const SensorModel& sensor, double z_m, double sigma_m) {
  cv::Mat depth_m;
  senseDepth(wallAt(z_m), sensor, 4).convertTo(depth_m, CV_64F);
  EXPECT_EQ(cv::countNonZero(depth_m), 640 * 480);
  cv::Scalar mean, deviation;
  cv::meanStdDev(depth_m, mean, deviation);
  EXPECT_NEAR(mean[0], z_m, 0.05 * sigma_m);
  EXPECT_NEAR(deviation[0], sigma_m, 0.04 * sigma_m);
}

TEST(SensorModel, AxialNoiseGrowsAsTheModelSays) {
  SensorModel unquantised = kinectSensor();
  unquantised.disparity_step_px = 0.0;
  for (const double z_m : {0.6, 1.0, 2.0, 4.0}) {
    const double sigma_m = 0.0012 + 0.0019 * (z_m - 0.4) * (z_m - 0.4);
    expectNoise(unquantised, z_m, sigma_m);
    expectNoise(kinectSensor(), z_m, sigma_m);
  }
  expectNoise(precisionSensor(), 0.3, 0.0001);
  expectNoise(partScanner(), 0.3, 0.000052);
}

TEST(SensorModel, NeighboursShareTheirNoise) {
  SensorModel sensor = kinectSensor();
  sensor.lateral_sigma_px = sensor.disparity_step_px = 0.0;
  const cv::Mat noise_m = senseDepth(wallAt(2.0), sensor, 4) - 2.0;
  const double variance = noise_m.dot(noise_m) / noise_m.total();
  for (int lag = 1; lag <= 4; ++lag) {
    const cv::Mat left = noise_m.colRange(0, 640 - lag).clone(), right = noise_m.colRange(lag, 640).clone();
    const double expected = std::exp(-std::pow(lag / (2.0 * sensor.noise_width_px), 2));
    EXPECT_NEAR(left.dot(right) / left.total() / variance, expected, 0.05) << lag;
  }
}

TEST(SensorModel, DisparityIsAMultipleOfAnEighthOfAPixel) {
  const cv::Mat depth_m = senseDepth(wallAt(3.0), kinectSensor(), 4);
  for (int u = 0; u < 640; ++u) {
    const double steps = 580.0 * 0.075 / depth_m.at<float>(200, u) * 8.0;
    EXPECT_NEAR(steps, std::round(steps), 1e-4);
  }
}

TEST(SensorModel, DropsEdgesGrazingRaysAndWhatIsOutOfRange) {
  const SensorModel kinect = kinectSensor();
  RenderedView view = wallAt(2.0);
  view.depth_m.colRange(320, 640) = 3.0;
  view.cos_incidence.rowRange(400, 480) = 0.0;
  const cv::Mat depth_m = senseDepth(view, kinect, 4);
  const auto kept = [&](const cv::Rect& area) {
    return static_cast<double>(cv::countNonZero(depth_m(area))) / area.area();
  };
  EXPECT_EQ(kept({0, 0, 300, 390}), 1.0);
  EXPECT_NEAR(kept({319, 0, 2, 390}), 1.0 - kinect.edge_dropout, 0.2);
  EXPECT_EQ(kept({0, 405, 640, 75}), 0.0);
  EXPECT_EQ(cv::countNonZero(senseDepth(wallAt(0.3), kinect, 4)), 0);
  EXPECT_EQ(cv::countNonZero(idealDepth(wallAt(5.5), kinect)), 0);
}

TEST(SceneLibrary, UnknownNameListsTheScenes) {
  try {
    makeScene("rom");
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("room, object"), std::string::npos) << error.what();
  }
}

TEST(SceneLibrary, AFolderRemembersItsScene) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "depth_fusion_scene_test";
  std::filesystem::create_directories(folder);
  writeSceneName(folder.string(), "object");
  EXPECT_EQ(findSceneName(folder.string()), "object");
  EXPECT_EQ(findSceneName("room"), "room");
  std::filesystem::remove_all(folder);
  EXPECT_THROW(findSceneName(folder.string()), Error);
  EXPECT_THROW(writeSceneName(folder.string(), "room"), Error);
}

}  // namespace
}  // namespace depth_fusion
