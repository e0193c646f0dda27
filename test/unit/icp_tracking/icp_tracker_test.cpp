#include "depth_fusion/icp_tracking/icp_tracker.h"

#include <gtest/gtest.h>

#include "depth_fusion/compute/device_image.h"
#include "depth_fusion/preprocessing/depth_preprocessor.h"
#include "icp_tracking/degeneracy.h"
#include "icp_tracking/icp_tracking_kernels.h"
#include "reference/icp_system.h"
#include "shared/types.h"
#include "support/normal_images.h"
#include "support/test_compute.h"
#include "tools/simulation/sensor_model.h"
#include "tools/simulation/simulated_recording.h"

namespace depth_fusion {
namespace {

constexpr double kDegree = M_PI / 180.0;

CameraIntrinsics cameraOfWidth(int width) {
  const double scale = width / 640.0;
  return {width, width * 3 / 4, 525.0 * scale, 525.0 * scale, 320.0 * scale - 0.5, 240.0 * scale - 0.5};
}

SimulatedRecording roomRecording() { return SimulatedRecording(SimulationOptions()); }

RgbdFrame frameOfScene(const Scene& scene, const CameraIntrinsics& camera, const Pose& T_W_D) {
  RgbdFrame frame;
  frame.depth = render(scene, camera, T_W_D).depth_m;
  return frame;
}

RgbdFrame frameOfRoom(const CameraIntrinsics& camera, const Pose& T_W_D) {
  static const SimulatedScene scene = makeScene("room");
  return frameOfScene(scene.surface, camera, T_W_D);
}

// A frame, preprocessed.
class Sight {
 public:
  Sight(const CameraIntrinsics& camera, const RgbdFrame& frame)
      : preprocessor_(compute(), {}, camera), depth_(preprocessor_.process(frame)) {}

  const DepthFrame& depth() const { return depth_; }

  reference::OrientedDepth read(int level) const {
    const DepthLevel& images = depth_.levels[level];
    return {images.camera, readImage(images.depth, images.camera),
            readNormals(images.normals, images.camera)};
  }

  // As if the map had been rendered from T_W_D.
  ModelView asView(const Pose& T_W_D) const {
    const reference::OrientedDepth images = read(0);
    ModelView view{images.camera, T_W_D, zeroImage(compute(), images.camera),
                   zeroImage(compute(), images.camera)};
    writeImage(view.depth, view.camera, images.depth);
    writeNormals(view.normals, view.camera, images.normals);
    return view;
  }

 private:
  DepthPreprocessor preprocessor_;
  const DepthFrame& depth_;
};

TrackingResult track(const Sight& sight, const ModelView& view, const Pose& T_W_D_prior,
                     const IcpTrackingParameters& parameters = {}) {
  IcpTracker tracker(compute(), parameters, view.camera);
  StageTimers timers;
  return tracker.track(sight.depth(), view, {T_W_D_prior, std::nullopt, ""}, timers);
}

void expectLost(const TrackingResult& result, const std::string& reason) {
  EXPECT_EQ(result.status, TrackingStatus::kLost);
  EXPECT_NE(result.reason.find(reason), std::string::npos) << result.reason;
}

double largestRelativeDifference(const IcpSystem& a, const IcpSystem& b) {
  const Vector6d scale = b.hessian.diagonal().cwiseSqrt();
  const Matrix6d hessian = (a.hessian - b.hessian).cwiseQuotient(scale * scale.transpose());
  const Matrix6d structure = (a.structure - b.structure).cwiseQuotient(scale * scale.transpose());
  const Vector6d gradient = (a.gradient - b.gradient).cwiseQuotient(scale * std::sqrt(b.squared_residuals));
  return std::max(
      {hessian.cwiseAbs().maxCoeff(), structure.cwiseAbs().maxCoeff(), gradient.cwiseAbs().maxCoeff()});
}

TEST(IcpSystem, EqualsTheReferenceWithNumericalJacobian) {
  const SimulatedRecording recording = roomRecording();
  for (const int width : {200, 320}) {
    const CameraIntrinsics camera = cameraOfWidth(width);
    const Pose T_W_M = recording.poseOf(0).T_W_D;
    const Pose T_W_D = recording.poseOf(9).T_W_D;
    const Sight model(camera, frameOfRoom(camera, T_W_M));
    const Sight source(camera, frameOfRoom(camera, T_W_D));
    const reference::OrientedDepth model_images = model.read(0);
    const Pose start = interpolate({0.0, T_W_M.inverse() * T_W_D}, {1.0, Pose::Identity()}, 0.3);
    IcpTracker::Kernels kernels(compute());
    DeviceBuffer sums(compute(), camera.height * ICP_SUMS * sizeof(float), "sums");
    for (int level = 0; level < DepthFrame::kLevels; ++level) {
      const IcpSystem system = kernels.accumulateSystem(source.depth().levels[level], model.asView(T_W_M),
                                                        start, {0.05f, 0.9f, 1.5f}, sums);
      const IcpSystem expected =
          reference::IcpReference(model_images, start, 0.05, 0.9, 1.5).accumulate(source.read(level));
      EXPECT_EQ(system.source_points, expected.source_points);
      EXPECT_GT(expected.inliers, 0.3 * expected.source_points);
      EXPECT_LT(expected.inliers, 0.99 * expected.source_points);
      EXPECT_NEAR(system.inliers / expected.inliers, 1.0, 1e-3);
      EXPECT_NEAR(system.covered_points / expected.covered_points, 1.0, 1e-3);
      EXPECT_NEAR(system.weights / expected.weights, 1.0, 1e-3);
      EXPECT_NEAR(system.rmse() / expected.rmse(), 1.0, 1e-3);
      EXPECT_NEAR(system.fit / expected.fit, 1.0, 1e-3);
      EXPECT_LT(largestRelativeDifference(system, expected), 1e-3);
    }
  }
}

// The exact system of points with normals: residuals are those of a small motion.
IcpSystem systemOf(const std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>>& surface,
                   const Vector6d& motion) {
  IcpSystem system;
  for (const auto& [p, n] : surface) {
    Vector6d jacobian;
    jacobian << p.cross(n), n;
    system.hessian += jacobian * jacobian.transpose();
    system.gradient -= jacobian * jacobian.dot(motion);
    system.weights += 1.0;
  }
  return system;
}

// Points on the planes through (0, 0, 2) with the given normals.
std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> planes(const std::vector<Eigen::Vector3d>& normals) {
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> surface;
  for (const Eigen::Vector3d& n : normals) {
    const Eigen::Vector3d a = n.unitOrthogonal();
    const Eigen::Vector3d b = n.cross(a);
    for (int i = -5; i <= 5; ++i) {
      for (int j = -5; j <= 5; ++j)
        surface.emplace_back(Eigen::Vector3d(0, 0, 2) + 0.1 * i * a + 0.1 * j * b, n);
    }
  }
  return surface;
}

const Eigen::AlignedBox3d kBox(Eigen::Vector3d(-0.5, -0.5, 1.5), Eigen::Vector3d(0.5, 0.5, 2.5));

TEST(DegeneracyAnalysis, SolvesWhereNothingIsFree) {
  Vector6d motion;
  motion << 0.01, -0.02, 0.03, 0.1, -0.2, 0.05;
  const IcpSystem system = systemOf(planes({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}), motion);
  const DegeneracyAnalysis analysis(system, system.hessian, kBox, 0.005);
  EXPECT_EQ(analysis.freeDirections(), 0);
  EXPECT_TRUE(analysis.solve().isApprox(motion, 1e-9));
  EXPECT_TRUE(analysis.constrained().hessian.isApprox(system.hessian, 1e-9));
  EXPECT_EQ(analysis.freeDirectionNames(), "");
}

TEST(DegeneracyAnalysis, NamesWhatAPlaneLeavesFree) {
  Vector6d motion;
  motion << 0.01, -0.02, 0.03, 0.1, -0.2, 0.05;
  const IcpSystem system = systemOf(planes({{0, 0, 1}}), motion);
  const DegeneracyAnalysis analysis(system, system.hessian, kBox, 0.005);
  EXPECT_EQ(analysis.freeDirections(), 3);
  EXPECT_NEAR(analysis.smallestEigenvalue(), 0.0, 1e-9);
  const std::string names = analysis.freeDirectionNames();
  EXPECT_NE(names.find("rotating about z"), std::string::npos) << names;
  EXPECT_NE(names.find("sliding along"), std::string::npos) << names;
  // The motion found moves the plane as the true one does, and nothing within it.
  const Vector6d found = analysis.solve();
  EXPECT_NEAR(found(0), motion(0), 1e-9);
  EXPECT_NEAR(found(1), motion(1), 1e-9);
  EXPECT_NEAR(found(5), motion(5), 1e-9);
  EXPECT_NEAR(found(2), 0.0, 1e-9);
  // Of a motion so far it takes back what lies within the plane.
  const Vector6d back = analysis.solve(motion) - found;
  EXPECT_NEAR(back(2), -motion(2), 1e-9);
  EXPECT_NEAR(back(0), 0.0, 1e-9);
  EXPECT_NEAR(back(1), 0.0, 1e-9);
}

TEST(DegeneracyAnalysis, TwoPlanesLeaveOneDirection) {
  const IcpSystem system = systemOf(planes({{0, 1, 0}, {0, 0, 1}}), Vector6d::Ones() * 0.01);
  const DegeneracyAnalysis analysis(system, system.hessian, kBox, 0.005);
  EXPECT_EQ(analysis.freeDirectionNames(), "sliding along x");
}

// A wall, and a prior that was measured: along the wall the pose is the prior's, across it that of geometry.
TEST(IcpTracker, AMeasuredPriorFillsWhatAPlaneLeavesFree) {
  const CameraIntrinsics camera = cameraOfWidth(320);
  const Scene wall({plane({0, 0, 1.5}, {0, 0, -1}, Material())});
  const ModelView view = Sight(camera, frameOfScene(wall, camera, Pose::Identity())).asView(Pose::Identity());
  Pose truth = Pose::Identity();
  truth.translation() << 0.02, -0.01, 0.01;
  MotionPrior prior{truth, Matrix6d(1e-6 * Matrix6d::Identity()), {}};
  prior.T_W_D.translation().z() = 0.0;
  IcpTracker tracker(compute(), {}, camera);
  StageTimers timers;
  const Sight sight(camera, frameOfScene(wall, camera, truth));
  const TrackingResult result = tracker.track(sight.depth(), view, prior, timers);
  ASSERT_EQ(result.status, TrackingStatus::kDegenerate) << result.reason;
  EXPECT_NE(result.reason.find("sliding along"), std::string::npos) << result.reason;
  EXPECT_LT((result.T_W_D.translation() - truth.translation()).norm(), 0.001) << result.T_W_D.translation();
  EXPECT_GT(result.covariance(3, 3), 10.0 * result.covariance(5, 5));
}

TEST(IcpTracker, RecoversAKnownMotion) {
  const SimulatedRecording recording = roomRecording();
  const CameraIntrinsics camera = cameraOfWidth(320);
  const Pose T_W_M = recording.poseOf(0).T_W_D;
  const Sight model(camera, frameOfRoom(camera, T_W_M));
  const ModelView view = model.asView(T_W_M);
  for (const int frame : {1, 3, 6}) {
    const Pose truth = recording.poseOf(frame).T_W_D;
    const TrackingResult result = track(Sight(camera, frameOfRoom(camera, truth)), view, T_W_M);
    ASSERT_EQ(result.status, TrackingStatus::kTracking) << result.reason;
    const Pose error = truth.inverse() * result.T_W_D;
    EXPECT_LT(error.translation().norm(), 0.0005) << (T_W_M.inverse() * truth).translation().norm();
    EXPECT_LT(rotationAngle(error), 0.05 * kDegree) << rotationAngle(T_W_M.inverse() * truth) / kDegree;
    EXPECT_GT(result.inlier_fraction, 0.8);
    EXPECT_LT(result.rmse_m, 0.005);
    EXPECT_GT(result.iterations, 2);
  }
}

TEST(IcpTracker, LostWithoutDepth) {
  const CameraIntrinsics camera = cameraOfWidth(160);
  const Pose T_W_M = roomRecording().poseOf(0).T_W_D;
  const Sight room(camera, frameOfRoom(camera, T_W_M));
  RgbdFrame empty;
  empty.depth = cv::Mat::zeros(camera.height, camera.width, CV_32FC1);
  const Sight nothing(camera, empty);
  expectLost(track(nothing, room.asView(T_W_M), T_W_M), "no points with depth and normal");
  expectLost(track(room, nothing.asView(T_W_M), T_W_M), "no point matches the view");
}

TEST(IcpTracker, LostInAnotherPlace) {
  const CameraIntrinsics camera = cameraOfWidth(160);
  const Pose T_W_M = roomRecording().poseOf(0).T_W_D;
  const ModelView view = Sight(camera, frameOfRoom(camera, T_W_M)).asView(T_W_M);
  for (const double turn_rad : {0.8, 1.6, 3.0}) {
    const Pose elsewhere = T_W_M * Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitY());
    const TrackingResult result = track(Sight(camera, frameOfRoom(camera, elsewhere)), view, T_W_M);
    EXPECT_EQ(result.status, TrackingStatus::kLost) << turn_rad << " " << result.inlier_fraction;
    EXPECT_NE(result.reason, "");
  }
}

TEST(IcpTracker, LostAfterAJump) {
  const CameraIntrinsics camera = cameraOfWidth(160);
  const Pose T_W_M = roomRecording().poseOf(0).T_W_D;
  const Pose T_W_D = roomRecording().poseOf(6).T_W_D;
  const ModelView view = Sight(camera, frameOfRoom(camera, T_W_M)).asView(T_W_M);
  IcpTrackingParameters parameters;
  parameters.max_translation_m =
      0.5f * static_cast<float>((T_W_D.translation() - T_W_M.translation()).norm());
  expectLost(track(Sight(camera, frameOfRoom(camera, T_W_D)), view, T_W_M, parameters), "jump of");
}

TEST(IcpTracker, LostBeyondItsLimits) {
  const CameraIntrinsics camera = cameraOfWidth(160);
  const Pose T_W_M = roomRecording().poseOf(0).T_W_D;
  const ModelView view = Sight(camera, frameOfRoom(camera, T_W_M)).asView(T_W_M);
  const Sight sight(camera, frameOfRoom(camera, roomRecording().poseOf(3).T_W_D));
  ASSERT_EQ(track(sight, view, T_W_M).status, TrackingStatus::kTracking);
  IcpTrackingParameters many, nearly_all, exact;
  many.min_inliers = 160 * 120;
  expectLost(track(sight, view, T_W_M, many), "points with depth and normal");
  nearly_all.min_inlier_fraction = 1.0f;
  expectLost(track(sight, view, T_W_M, nearly_all), "inliers");
  exact.max_rmse_m = 1e-5f;
  expectLost(track(sight, view, T_W_M, exact), "rmse");
}

// A wall alone leaves three motions free, and nothing says how the sensor moved along them.
TEST(IcpTracker, GuessesBeforeAWall) {
  const CameraIntrinsics camera = cameraOfWidth(160);
  Pose T_W_D = Pose::Identity();
  for (const double tilt_rad : {0.0, 0.4}) {
    T_W_D.linear() = Eigen::AngleAxisd(tilt_rad, Eigen::Vector3d(0.6, 0.8, 0.0)).toRotationMatrix();
    const Scene wall({plane(Eigen::Vector3d(0, 0, 1.5), -Eigen::Vector3d::UnitZ(), Material())});
    const RgbdFrame frame = frameOfScene(wall, camera, T_W_D);
    const ModelView view = Sight(camera, frame).asView(T_W_D);
    const TrackingResult result = track(Sight(camera, frame), view, T_W_D);
    EXPECT_EQ(result.status, TrackingStatus::kDegenerate);
    EXPECT_EQ(result.guessed_directions, 3) << result.reason;
  }
}

Scene bareWall() { return Scene({plane({0, 0, 1.5}, {0, 0, -1}, Material())}); }

// A column on the y axis of its camera, with nothing behind.
Scene bareColumn() { return Scene({cylinder({0, -2, 1.5}, {0, 2, 1.5}, 0.5, Material())}); }

RgbdFrame sensedFrame(const Scene& scene, const CameraIntrinsics& camera, const Pose& T_W_D, uint64_t seed) {
  RgbdFrame frame;
  frame.depth = senseDepth(render(scene, camera, T_W_D), kinectSensor(), seed);
  return frame;
}

// The map is one frame, as noisy as the one that is tracked: the normals' errors do not make motions along
// the surface look determined.
TEST(IcpTracker, NoiseDeterminesNothing) {
  const CameraIntrinsics camera = cameraOfWidth(320);
  Pose truth = Pose::Identity();
  truth.translation() << 0.004, 0.01, 0.005;
  for (const auto& [scene, free] : {std::pair(bareWall(), 3), std::pair(bareColumn(), 2)}) {
    for (const uint64_t seed : {1, 2, 3}) {
      const Sight model(camera, sensedFrame(scene, camera, Pose::Identity(), seed));
      const ModelView view = model.asView(Pose::Identity());
      const Sight sight(camera, sensedFrame(scene, camera, truth, seed + 100));
      const TrackingResult result = track(sight, view, Pose::Identity());
      ASSERT_EQ(result.status, TrackingStatus::kDegenerate) << result.smallest_eigenvalue;
      EXPECT_EQ(result.guessed_directions, free) << result.reason;
      EXPECT_NEAR(result.T_W_D.translation().y(), 0.0, 0.002) << "stays where it was expected";
      EXPECT_NEAR(result.T_W_D.translation().z(), truth.translation().z(), 0.001) << "is measured";
      EXPECT_GT(result.covariance(4, 4), 0.01);
      EXPECT_LT(result.covariance(5, 5), 1e-4);
    }
  }
}

// The rotation's rounding error tripled with each frame once: after 35 frames, no pose was left.
TEST(IcpTracker, PosesStayOrthonormalOverManyFrames) {
  const CameraIntrinsics camera = cameraOfWidth(160);
  IcpTracker tracker(compute(), {}, camera);
  StageTimers timers;
  const Pose start = roomRecording().poseOf(0).T_W_D;
  const Sight sight(camera, frameOfRoom(camera, start));
  ModelView view = sight.asView(start);
  for (int i = 0; i < 200; ++i) {
    const TrackingResult result = tracker.track(sight.depth(), view, {view.T_W_D, std::nullopt, ""}, timers);
    ASSERT_EQ(result.status, TrackingStatus::kTracking) << i << " " << result.reason;
    view.T_W_D = result.T_W_D;
  }
  const Eigen::Matrix3d rotation = view.T_W_D.linear();
  EXPECT_LT((rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_LT((start.inverse() * view.T_W_D).translation().norm(), 1e-3);
}

}  // namespace
}  // namespace depth_fusion
