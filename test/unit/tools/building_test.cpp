// Scenes of many rooms: what is seen of them, and the walks through them.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "depth_fusion/geometry/angles.h"
#include "support/expect_error.h"
#include "tools/simulation/building_plan.h"
#include "tools/simulation/simulated_recording.h"

namespace depth_fusion {
namespace {

using Eigen::Vector3d;

SimulatedRecording recordingOf(const std::string& scene, const std::string& walk = "") {
  SimulationOptions options;
  options.scene = scene;
  options.walk = walk;
  options.intrinsics = halved(halved(makeScene(scene).sensor.camera));
  return SimulatedRecording(options);
}

class ManySolids : public testing::TestWithParam<std::string> {};

TEST_P(ManySolids, DistanceIsThatToTheNearest) {
  const Scene scene = makeScene(GetParam()).surface;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> x(-32.0, 32.0), y(-16.0, 16.0), z(-0.3, 2.9);
  for (int i = 0; i < 1000; ++i) {
    const Vector3d p(x(random), y(random), z(random));
    double nearest_m = 1e9;
    for (const Primitive& solid : scene.primitives()) nearest_m = std::min(nearest_m, solid.distance(p));
    EXPECT_EQ(scene.distance(p), nearest_m) << p.transpose();
  }
}

TEST_P(ManySolids, ARaySeesTheFirstOfAllSolids) {
  const SimulatedRecording simulated = recordingOf(GetParam());
  const Scene& scene = simulated.scene().surface;
  const CameraIntrinsics& camera = simulated.intrinsics();
  for (int frame = 0; frame < 8000; frame += 1600) {
    const Pose T_W_D = simulated.poseOf(frame).T_W_D;
    const RenderedView view = render(scene, camera, T_W_D);
    for (int pixel = 7; pixel < camera.width * camera.height; pixel += 211) {
      const int u = pixel % camera.width, v = pixel / camera.width;
      const Vector3d ray_D =
          Vector3d((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1.0).normalized();
      double range_m = 30.0;
      for (const Primitive& solid : scene.primitives()) {
        range_m = std::min(range_m,
                           solid.firstHit(T_W_D.translation(), T_W_D.linear() * ray_D, 30.0).value_or(30.0));
      }
      const float depth_m = range_m < 30.0 ? static_cast<float>(range_m * ray_D.z()) : 0.0f;
      ASSERT_EQ(view.depth_m.at<float>(v, u), depth_m) << frame << ": " << u << " " << v;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Simulation, ManySolids, testing::Values("room", "building", "corridor"));

struct WalkRow {
  const char* scene;
  const char* walk;
  double length_m;
};

class WalkTest : public testing::TestWithParam<WalkRow> {};

TEST_P(WalkTest, StaysClearIsSmoothAndReturns) {
  constexpr double kStep_s = 0.1;
  const SimulatedScene scene = makeScene(GetParam().scene);
  const auto walk = std::find_if(scene.walks.begin(), scene.walks.end(),
                                 [](const Walk& walk) { return walk.name == GetParam().walk; });
  ASSERT_NE(walk, scene.walks.end());
  for (unsigned seed = 1; seed < 4; ++seed) {
    double length_m = 0.0;
    for (double time_s = 0.0; time_s < walk->round_s; time_s += kStep_s) {
      const Pose T_W_D = handHeldPose(walk->path, seed, {}, time_s);
      const Pose motion = T_W_D.inverse() * handHeldPose(walk->path, seed, {}, time_s + kStep_s);
      length_m += motion.translation().norm();
      ASSERT_GE(scene.surface.distance(T_W_D.translation()), 0.4) << T_W_D.translation().transpose();
      ASSERT_LE(motion.translation().norm(), 1.0 * kStep_s) << time_s;
      ASSERT_LE(rotationAngle(motion) * kDegPerRad, 60.0 * kStep_s) << time_s;
    }
    EXPECT_NEAR(length_m, GetParam().length_m, 5.0);
    const Pose way =
        handHeldPose(walk->path, seed, {}, 0.0).inverse() * handHeldPose(walk->path, seed, {}, walk->round_s);
    EXPECT_LE(way.translation().norm(), 0.2);
    EXPECT_LE(rotationAngle(way) * kDegPerRad, 20.0);
  }
}

INSTANTIATE_TEST_SUITE_P(Simulation, WalkTest,
                         testing::Values(WalkRow{"building", "tour", 102.0},
                                         WalkRow{"building", "loop", 284.0},
                                         WalkRow{"building", "laps", 141.0},
                                         WalkRow{"corridor", "there_and_back", 212.0}));

TEST(Building, RendersAlikeFromBothOfTheRoomsThatAreAlike) {
  const Scene scene = makeScene("building").surface;
  const CameraIntrinsics camera = halved(kinectSensor().camera);
  for (int i = 0; i < 8; ++i) {  // looks anywhere but through the door
    const double bearing_rad = (-20.0 + 30.0 * i) / kDegPerRad;
    const GazePath standing = [&](const Sway&, const Sway&) {
      const Vector3d eye_W(0.5, -0.25, 1.5);
      return Gaze{eye_W, eye_W + Vector3d(std::cos(bearing_rad), std::sin(bearing_rad), -0.3)};
    };
    Pose T_room_D = handHeldPose(standing, 1, {}, 0.0);
    // Moving it by whole metres rounds nothing then.
    T_room_D.translation() = (T_room_D.translation() * 1024.0).array().round() / 1024.0;
    const RenderedView first = render(scene, camera, buildingTwin(0) * T_room_D);
    const RenderedView second = render(scene, camera, buildingTwin(1) * T_room_D);
    EXPECT_EQ(cv::norm(first.depth_m, second.depth_m, cv::NORM_INF), 0.0) << i;
    EXPECT_EQ(cv::norm(first.color, second.color, cv::NORM_INF), 0.0) << i;
  }
}

TEST(Building, EveryOtherRoomIsDifferent) {
  const Scene scene = makeScene("building").surface;
  const CameraIntrinsics camera = halved(halved(kinectSensor().camera));
  std::vector<cv::Mat> views;
  for (const double x_m : {-25.0, -15.0, -5.0, 5.0, 25.0}) {
    for (const double y_m : {-11.5, 11.5}) {
      Pose T_W_D = Pose::Identity();
      T_W_D.linear() << (y_m > 0 ? 1 : -1), 0, 0, 0, 0, (y_m > 0 ? 1 : -1), 0, -1, 0;
      T_W_D.translation() << x_m, y_m, 1.5;
      views.push_back(render(scene, camera, T_W_D).depth_m);
    }
  }
  for (size_t i = 0; i < views.size(); ++i) {
    for (size_t j = 0; j < i; ++j)
      EXPECT_GT(cv::norm(views[i], views[j], cv::NORM_INF), 0.1) << i << " " << j;
  }
}

TEST(Walks, AnUnknownOneListsThoseThereAre) {
  expectError([] { recordingOf("building", "lap"); }, {"'building'", "'lap'", "tour, loop, laps"});
  expectError([] { recordingOf("room", "tour"); }, {"'room'", "one path only"});
}

TEST(Walks, AnotherOneLeadsElsewhere) {
  const Pose tour = recordingOf("building", "tour").poseOf(0).T_W_D;
  EXPECT_TRUE(tour.isApprox(recordingOf("building").poseOf(0).T_W_D, 0.0));
  EXPECT_GT((recordingOf("building", "loop").poseOf(0).T_W_D.translation() - tour.translation()).norm(), 5.0);
}

}  // namespace
}  // namespace depth_fusion
