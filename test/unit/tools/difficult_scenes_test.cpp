// What the difficult scenes show.
#include <gtest/gtest.h>

#include <cmath>

#include "tools/simulation/simulated_recording.h"

namespace depth_fusion {
namespace {

using Eigen::Vector3d;

const CameraIntrinsics kCamera{160, 120, 130.0, 130.0, 79.5, 59.5};

// Looks along y from the origin, 1 m above the ground.
Pose alongY() {
  Pose T_W_D = Pose::Identity();
  T_W_D.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  T_W_D.translation() << 0, 0, 1;
  return T_W_D;
}

float depthAt(const RenderedView& view, int u, int v) { return view.depth_m.at<float>(v, u); }

Primitive pane(Optics optics, double yaw_rad) {
  Material material;
  material.optics = optics;
  return box({0, 2, 1}, {2, 0.1, 2}, material, yaw_rad);
}

TEST(Optics, AMirrorShowsWhatIsBehindTheCameraAsFarAsTheWayOfTheLight) {
  const Scene scene({pane(Optics::kMirror, 0.0), plane({0, -3, 0}, {0, 1, 0}, {{50, 100, 150}})});
  const RenderedView view = render(scene, kCamera, alongY());
  EXPECT_NEAR(depthAt(view, 80, 60), 1.95 + 1.95 + 3.0, 1e-4);
  EXPECT_GT(view.color.at<cv::Vec3b>(60, 80)[2], 50);
}

TEST(Optics, GlassShowsWhatIsBehindItAndHidesDepthAslant) {
  const Primitive wall = plane({0, 4, 0}, {0, -1, 0}, {{50, 100, 150}});
  const RenderedView free = render(Scene({wall}), kCamera, alongY());
  const RenderedView straight = render(Scene({pane(Optics::kGlass, 0.0), wall}), kCamera, alongY());
  EXPECT_NEAR(depthAt(straight, 80, 60), 4.0, 1e-4);
  const RenderedView aslant = render(Scene({pane(Optics::kGlass, 1.0), wall}), kCamera, alongY());
  EXPECT_EQ(depthAt(aslant, 80, 60), 0.0f);
  EXPECT_EQ(cv::norm(free.color, aslant.color, cv::NORM_INF), 0.0);
}

TEST(Primitive, WhatIsMovedKeepsItsTexture) {
  const Primitive body = box({0.1, 0, 0.2}, {0.4, 0.3, 0.5}, {{90, 120, 150}, Pattern::kMottle, 0.1, 0.6});
  Pose T_W_moved(Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()));
  T_W_moved.pretranslate(Vector3d(0.5, -0.25, 1.0));
  Pose T_W_D = alongY();
  T_W_D.translation() << 0.1, -1.0, 0.2;
  const RenderedView before = render(Scene({body}), kCamera, T_W_D);
  const RenderedView after = render(Scene({body.moved(T_W_moved)}), kCamera, T_W_moved * T_W_D);
  cv::Mat difference;
  cv::absdiff(before.color, after.color, difference);
  EXPECT_LT(cv::mean(difference)[0], 0.1);
  EXPECT_LT(cv::norm(before.depth_m, after.depth_m, cv::NORM_L1) / before.depth_m.total(), 1e-3);
  const Vector3d p(0.3, 0.4, 0.5);
  EXPECT_NEAR(body.moved(T_W_moved).distance(T_W_moved * p), body.distance(p), 1e-9);
}

TEST(RollingShutter, EachRowIsThatOfItsPose) {
  const Scene scene = makeScene("room").surface;
  const auto poseOfRow = [](int row) {
    return SimulatedRecording({}).poseOf(0).T_W_D * poseFromTwist(Vector6d::Constant(0.001 * row));
  };
  const RenderedView rolling = renderRows(scene, kCamera, poseOfRow);
  for (const int row : {0, 50, 119}) {
    const RenderedView still = render(scene, kCamera, poseOfRow(row));
    EXPECT_EQ(cv::norm(rolling.depth_m.row(row), still.depth_m.row(row), cv::NORM_INF), 0.0);
    EXPECT_EQ(cv::norm(rolling.color.row(row), still.color.row(row), cv::NORM_INF), 0.0);
  }
}

// What a scene shows more than its surface, as a part of the image.
double hidden(const std::string& name, double time_s) {
  SimulationOptions options;
  options.scene = name;
  const SimulatedRecording recording(options);
  const Pose T_W_D = recording.poseOf(static_cast<int>(30 * time_s)).T_W_D;
  std::vector<Primitive> solids = recording.scene().also_seen(T_W_D, time_s);
  for (const Primitive& solid : recording.scene().surface.primitives()) solids.push_back(solid);
  const RenderedView with = render(Scene(solids), kCamera, T_W_D);
  const RenderedView without = render(recording.scene().surface, kCamera, T_W_D);
  return cv::countNonZero(with.depth_m != without.depth_m) / static_cast<double>(with.depth_m.total());
}

TEST(DifficultScenes, SomebodyFillsSixtyPercentOfTheView) {
  EXPECT_EQ(hidden("person", 0.9), 0.0);
  for (const double time_s : {2.1, 2.5, 2.9}) EXPECT_NEAR(hidden("person", time_s), 0.6, 0.1) << time_s;
  EXPECT_EQ(hidden("person", 4.1), 0.0);
}

TEST(DifficultScenes, TheHandCoversAll) {
  EXPECT_EQ(hidden("hand", 0.9), 0.0);
  EXPECT_EQ(hidden("hand", 1.4), 1.0);
  EXPECT_EQ(hidden("hand", 1.9), 0.0);
}

TEST(DifficultScenes, TheTurningThingsFillAPartOfTheView) {
  EXPECT_GT(hidden("turntable", 2.0), 0.1);
  EXPECT_LT(hidden("turntable", 2.0), 0.3);
}

TEST(DifficultScenes, MirrorAndGlassAreSeen) {
  EXPECT_GT(hidden("mirror", 4.0), 0.1);
  EXPECT_GT(hidden("glass", 1.0), 0.1);
}

TEST(DifficultScenes, TheShakesAreAsFastAsSaid) {
  SimulationOptions options;
  options.scene = "shaken";
  options.tremor = 0.0;
  const SimulatedRecording recording(options);
  double fastest_deg_s = 0.0;
  for (int i = 60; i < 150; ++i) {
    const Pose motion = recording.poseOf(i).T_W_D.inverse() * recording.poseOf(i + 1).T_W_D;
    fastest_deg_s = std::max(fastest_deg_s, 30.0 * rotationAngle(motion) * 180.0 / 3.141592653589793);
  }
  EXPECT_NEAR(fastest_deg_s, 120.0, 10.0);
}

TEST(LifelikeSensor, IsOnWhereItIsAskedFor) {
  SimulationOptions options;
  options.frames = 2;
  options.intrinsics = kCamera;
  const cv::Mat ideal = SimulatedRecording(options).next()->color;
  options.lifelike = true;
  EXPECT_GT(cv::norm(SimulatedRecording(options).next()->color, ideal, cv::NORM_L1) / ideal.total(), 3.0);
  EXPECT_GT(SimulatedRecording(options).scene().sensor.readout_s, 0.0);
}

}  // namespace
}  // namespace depth_fusion
