// The model view by marching cubes, against the truth and against ray casting.
#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "depth_fusion/common/percentile.h"
#include "depth_fusion/pipeline/reconstruction_pipeline.h"
#include "support/rendered_views.h"
#include "tools/simulation/simulated_recording.h"

namespace depth_fusion {
namespace {

Images renderTriangles(BlockMap& map, const Pose& T_W_D, float max_range_m = kMaxRange_m) {
  return render(map, T_W_D, max_range_m, "marching_cubes");
}

class MeshRendererOfBlockSize : public testing::TestWithParam<int> {};

INSTANTIATE_TEST_SUITE_P(BlockSizes, MeshRendererOfBlockSize, testing::Values(4, 8, 16, 32));

TEST_P(MeshRendererOfBlockSize, ShowsASphereFromInsideAndOutsideOfTheWindow) {
  const auto map = makeMap(mapParameters(GetParam()), sphereDistance);
  for (const double from_m : {0.55, 1.3}) {
    for (const Eigen::Vector3d& side : {Eigen::Vector3d(0.1, 0, -1), {-0.6, 0.7, 0.4}, {0, 1, 0}}) {
      const Pose T_W_D = lookingAt(kCentre, from_m * side.normalized(), 0.4);
      const ViewErrors errors = compareWithSphere(renderTriangles(*map, T_W_D), T_W_D, 0.01);
      EXPECT_GT(errors.hits, 300u);
      EXPECT_EQ(errors.missing, 0u);
      EXPECT_EQ(errors.false_hits, 0u);
      EXPECT_LT(errors.mean_vox, 0.05);
      EXPECT_LT(errors.largest_vox, 0.2);
      EXPECT_LT(errors.largest_angle_rad, 0.05);
    }
  }
}

TEST_P(MeshRendererOfBlockSize, ShowsATiltedPlaneWithoutAHole) {
  const Eigen::Vector3d normal = Eigen::Vector3d(0.3, -0.2, -1.0).normalized();
  const double offset_m = -0.1234;
  const auto map =
      makeMap(mapParameters(GetParam()), [&](const Eigen::Vector3d& p) { return normal.dot(p) - offset_m; });
  Pose T_W_D = Pose::Identity();
  T_W_D.translation() = Eigen::Vector3d(0.02, 0.01, -0.5);
  const Images view = renderTriangles(*map, T_W_D);
  for (int y = 0; y < kCamera.height; ++y) {
    for (int x = 0; x < kCamera.width; ++x) {
      const double truth_m = (offset_m - normal.dot(T_W_D.translation())) / normal.dot(rayThrough(x, y));
      ASSERT_NEAR(view.depth.at<float>(y, x), truth_m, 0.0005) << x << " " << y;
      const cv::Vec3f n = view.normals.at<cv::Vec3f>(y, x);
      ASSERT_NEAR((Eigen::Vector3d(n[0], n[1], n[2]) - normal).norm(), 0.0, 0.03) << x << " " << y;
    }
  }
}

TEST(MeshRenderer, ShowsNothingBeyondItsRangeNorBehindTheCamera) { expectNothingOutOfRange(renderTriangles); }

TEST(MeshRenderer, ShowsNoSurfaceFromBehind) {
  const auto map = makeMap(mapParameters(8), sphereDistance);
  EXPECT_EQ(cv::countNonZero(
                renderTriangles(*map, lookingAt(kCentre + Eigen::Vector3d::UnitX(), kCentre, 0.0)).depth),
            0);
}

TEST(MeshRenderer, EmptyMapShowsNothing) {
  BlockMap map(compute(), mapParameters(8));
  EXPECT_EQ(cv::countNonZero(renderTriangles(map, Pose::Identity()).depth), 0);
}

// Each view begins anew, and views that are held stay.
TEST(MeshRenderer, ViewsDoNotMix) {
  const auto map = makeMap(mapParameters(8), sphereDistance);
  ModelViewRenderer renderer(compute(), *map, kCamera, {"marching_cubes"});
  StageTimers timers;
  const Pose T_W_D = lookingAt(kCentre, Eigen::Vector3d(0.0, 0.0, -1.0), 0.0);
  renderer.render(T_W_D, kMinRange_m, kMaxRange_m, timers);
  const std::shared_ptr<const ModelView> held = renderer.view();
  const cv::Mat first = readImage(held->depth, kCamera);
  const Pose away = lookingAt(Eigen::Vector3d(0.0, 0.0, -3.0), Eigen::Vector3d(0.0, 0.0, -1.5), 0.0);
  EXPECT_EQ(
      cv::countNonZero(readImage(renderer.render(away, kMinRange_m, kMaxRange_m, timers).depth, kCamera)), 0);
  EXPECT_EQ(cv::norm(readImage(held->depth, kCamera), first, cv::NORM_INF), 0.0);
  const Pose beside =
      lookingAt(kCentre + Eigen::Vector3d(0.3, 0.0, 0.0), Eigen::Vector3d(0.0, 0.0, -1.0), 0.0);
  renderer.render(beside, kMinRange_m, kMaxRange_m, timers);
  const ModelView& nothing = renderer.render(away, kMinRange_m, kMaxRange_m, timers);
  EXPECT_EQ(cv::countNonZero(readNormals(nothing.normals, kCamera).reshape(1)), 0);
  const ModelView& again = renderer.render(T_W_D, kMinRange_m, kMaxRange_m, timers);
  EXPECT_EQ(cv::norm(readImage(again.depth, kCamera), first, cv::NORM_INF), 0.0);
}

// A ball that is full of noise has far more triangles than a batch holds: its blocks are drawn in parts.
TEST(MeshRenderer, DrawsWhatIsTooMuchForABatchInParts) {
  constexpr double kBall_m = 0.5;
  const auto noisy_ball = [](const Eigen::Vector3d& p) {
    const double shell = (p - kCentre).norm() - kBall_m;
    return shell > -0.015 ? shell : 0.039 * std::sin(31000.0 * p.x() + 17000.0 * p.y() + 23000.0 * p.z());
  };
  const auto map = makeMap(mapParameters(16), noisy_ball);
  const Pose T_W_D = lookingAt(kCentre, kCentre - 1.3 * Eigen::Vector3d::UnitZ(), 0.0);
  const cv::Mat depth = renderTriangles(*map, T_W_D).depth;
  int hits = 0;
  for (int y = 0; y < kCamera.height; ++y) {
    for (int x = 0; x < kCamera.width; ++x) {
      const Eigen::Vector3d ray = rayThrough(x, y).normalized();
      const double off_m = 1.3 * std::sqrt(1.0 - ray.z() * ray.z());
      if (off_m > 0.9 * kBall_m) continue;
      ++hits;
      const double truth_m = 1.3 * ray.z() - std::sqrt(kBall_m * kBall_m - off_m * off_m);
      ASSERT_NEAR(depth.at<float>(y, x), truth_m * ray.z(), 0.003) << x << " " << y;
    }
  }
  EXPECT_GT(hits, 1000);
}

class RoomByTriangles : public testing::Test {
 protected:
  static PipelineParameters parametersOf(const std::string& renderer) {
    PipelineParameters parameters;
    parameters.map.voxel_size_m = 0.01f;
    parameters.map.blocks_per_axis = 128;
    parameters.map.pool_mib = 64;
    parameters.model_view.renderer = renderer;
    return parameters;
  }
  static SimulationOptions recordingOptions() {
    SimulationOptions options;
    options.frames = 40;
    options.intrinsics = {320, 240, 262.5, 262.5, 159.5, 119.5};
    return options;
  }
};

struct ViewOfRoom {
  double seen = 0.0;                        // part of the pixels with depth
  double far = 0.0;                         // part of these whose depth is wrong by more than a voxel
  double median_m = 0.0, median_rad = 0.0;  // errors of the others
};

ViewOfRoom compareWithRoom(const Images& view, const RgbdFrame& truth, const Scene& room) {
  std::vector<double> errors_m, errors_rad;
  int pixels = 0, seen = 0;
  for (int y = 0; y < view.depth.rows; ++y) {
    for (int x = 0; x < view.depth.cols; ++x) {
      const float z = truth.depth.at<float>(y, x);
      if (!(z > 0.3f && z < 5.0f)) continue;
      ++pixels;
      if (view.depth.at<float>(y, x) == 0.0f) continue;
      ++seen;
      const double error_m = std::abs(view.depth.at<float>(y, x) - z);
      if (error_m > 0.01) continue;
      const CameraIntrinsics& camera = truth.intrinsics;
      const Eigen::Vector3d p_W =
          *truth.T_W_D * (z * Eigen::Vector3d((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1.0));
      Eigen::Vector3d normal_W;
      for (int axis = 0; axis < 3; ++axis) {
        const Eigen::Vector3d step = 1e-4 * Eigen::Vector3d::Unit(axis);
        normal_W[axis] = room.distance(p_W + step) - room.distance(p_W - step);
      }
      const cv::Vec3f n = view.normals.at<cv::Vec3f>(y, x);
      const double cosine =
          (truth.T_W_D->linear() * Eigen::Vector3d(n[0], n[1], n[2])).dot(normal_W.normalized());
      errors_m.push_back(error_m);
      errors_rad.push_back(std::acos(std::min(cosine, 1.0)));
    }
  }
  return {seen / double(pixels), 1.0 - errors_m.size() / double(seen), percentile(errors_m, 0.5),
          percentile(errors_rad, 0.5)};
}

TEST_F(RoomByTriangles, LooksAsByRayCasting) {
  SimulationOptions options = recordingOptions();
  options.noise = false;
  SimulatedRecording recording(options);
  ReconstructionPipeline pipeline(compute(), parametersOf("ray_casting"), options.intrinsics);
  RgbdFrame frame;
  for (int i = 0; i < 10; ++i) {
    frame = *recording.next();
    pipeline.processFrame(frame, *frame.T_W_D);
  }
  ViewOfRoom views[2];
  for (int i = 0; i < 2; ++i) {
    ModelViewRenderer renderer(compute(), pipeline.map(), options.intrinsics,
                               {i == 0 ? "ray_casting" : "marching_cubes"});
    StageTimers timers;
    const ModelView& view = renderer.render(*frame.T_W_D, 0.3f, 5.0f, timers);
    views[i] = compareWithRoom(
        {readImage(view.depth, options.intrinsics), readNormals(view.normals, options.intrinsics)}, frame,
        recording.scene().surface);
    std::printf("%s: seen %.4f, far %.4f, median errors %.3f mm, %.2f degrees\n",
                i == 0 ? "rays" : "triangles", views[i].seen, views[i].far, 1000.0 * views[i].median_m,
                views[i].median_rad * 57.29578);
  }
  EXPECT_GT(views[1].seen, views[0].seen - 0.02);
  EXPECT_LT(views[1].far, views[0].far + 0.005);
  EXPECT_LT(views[1].median_m, 0.001);
  EXPECT_LT(views[1].median_rad, views[0].median_rad + 0.005);
}

double rmsError(const std::string& renderer, const PipelineParameters& parameters,
                const SimulationOptions& options) {
  SimulatedRecording recording(options);
  ReconstructionPipeline pipeline(compute(), parameters, options.intrinsics);
  const Pose T_M_W = recording.poseOf(0).T_W_D.inverse();
  double sum_m2 = 0.0;
  while (const std::optional<RgbdFrame> frame = recording.next()) {
    const TrackingResult tracking = pipeline.processFrame(*frame).tracking;
    EXPECT_EQ(tracking.status, TrackingStatus::kTracking) << renderer << " " << tracking.reason;
    sum_m2 += (tracking.T_W_D.translation() - (T_M_W * *frame->T_W_D).translation()).squaredNorm();
  }
  return std::sqrt(sum_m2 / options.frames);
}

TEST_F(RoomByTriangles, IsTrackedAsByRayCasting) {
  const SimulationOptions options = recordingOptions();
  const double cast_m = rmsError("ray_casting", parametersOf("ray_casting"), options);
  const double triangles_m = rmsError("marching_cubes", parametersOf("marching_cubes"), options);
  std::printf("error of the poses: %.2f mm by ray casting, %.2f mm by marching cubes\n", 1000.0 * cast_m,
              1000.0 * triangles_m);
  EXPECT_LT(triangles_m, 1.5 * cast_m + 0.0005);
}

}  // namespace
}  // namespace depth_fusion
