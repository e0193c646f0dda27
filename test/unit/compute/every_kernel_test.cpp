// Every kernel of the project at a small size, for checkers that run kernels slowly (test/oclgrind). What the
// kernels compute is tested elsewhere: here they only have to leave something behind.
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "compute/kernel.h"
#include "depth_fusion/compute/device_image.h"
#include "depth_fusion/esdf/esdf.h"
#include "depth_fusion/pipeline/reconstruction_pipeline.h"
#include "depth_fusion/registration/frame_registration.h"
#include "depth_fusion/surface_mesh/surface_mesh.h"
#include "depth_fusion/surface_mesh/triangle_mesh.h"
#include "map/map_args.h"
#include "support/test_compute.h"
#include "tools/simulation/simulated_recording.h"
#include "tsdf_fusion/tsdf_fusion_kernels.h"

namespace depth_fusion {
namespace {

// Neither size is a multiple of a vector's, a tile's or a work-group's.
constexpr CameraIntrinsics kCamera{52, 38, 43.0, 43.0, 25.5, 18.5};
constexpr CameraIntrinsics kColorCamera{58, 44, 48.0, 48.0, 28.5, 21.5};

PipelineParameters smallParameters() {
  PipelineParameters parameters;
  parameters.map.voxel_size_m = 0.1f;
  parameters.map.blocks_per_axis = 12;
  parameters.map.pool_mib = 1;
  parameters.map.color = true;
  parameters.preprocessing.readout_s = 0.03f;
  parameters.preprocessing.max_relative_step = 1.0f;
  parameters.icp_tracking.min_inliers = 50;
  parameters.icp_tracking.min_inlier_fraction = 0.01f;
  parameters.icp_tracking.max_rmse_m = 1.0f;
  parameters.icp_tracking.coarse_iterations = 1;
  parameters.icp_tracking.middle_iterations = 1;
  parameters.icp_tracking.fine_iterations = 2;
  return parameters;
}

PipelineParameters coarseParameters() {
  PipelineParameters parameters = smallParameters();
  parameters.map.voxel_size_m = 0.2f;
  return parameters;
}

// A frame of the room as colour cameras beside the depth camera see it.
RgbdFrame roomFrame(int number) {
  SimulationOptions options;
  options.intrinsics = kCamera;
  options.frames = number + 1;
  SimulatedRecording recording(options);
  RgbdFrame frame;
  for (int i = 0; i <= number; ++i) frame = *recording.next();
  frame.color_intrinsics = kColorCamera;
  frame.T_C_D = Pose(Eigen::Translation3d(0.02, 0.0, 0.0));
  cv::resize(frame.color, frame.color, {kColorCamera.width, kColorCamera.height});
  return frame;
}

// A context a test: oclgrind's does not outlive the main function.
struct EveryKernel : testing::Test {
  ComputeContext compute{"", testSimdWidth(), testGroupSize()};
};

Vector6d someVelocity() { return Vector6d::Constant(0.2); }

TEST_F(EveryKernel, OfCompute) {
  DeviceBuffer layout(compute, 4096 * sizeof(int), "the layout");
  Kernel(compute, "compute/shared_types.cl", "report_layout").run(1, layout);
  EXPECT_GT(layout.read<int>(1).front(), 0);
}

TEST_F(EveryKernel, OfTheLimits) {
  constexpr size_t kItems = 8, kElements = 16 * 64 * kItems;
  DeviceBuffer a(compute, kElements * sizeof(float), "a limit"),
      b(compute, kElements * sizeof(float), "a limit");
  a.fill(0, a.bytes());
  Kernel(compute, "compute/limits.cl", "do_nothing").run(1, a);
  Kernel(compute, "compute/limits.cl", "multiply_add").run(kItems, a, 4, 0.5f);
  Kernel(compute, "compute/limits.cl", "gather_words").run(kItems, a, b, 4, 63);
  Kernel(compute, "compute/limits.cl", "copy_memory").run(kItems, a, b);
  EXPECT_EQ(b.read<float>(1), a.read<float>(1));
}

TEST_F(EveryKernel, OfRegistration) {
  RegistrationParameters parameters;
  parameters.depth_to_color = true;
  RgbdFrame frame = roomFrame(0);
  frame.distortion = {0.1, -0.05, 0.001, 0.001, 0.01, 0.05, 0.02, 0.01};
  FrameRegistration registration(compute, parameters);
  EXPECT_GT(cv::countNonZero(registration.process(frame).depth), 0);
  frame.depth.convertTo(frame.depth, CV_16UC1, 1000.0);
  frame.depth_unit_m = 0.001;
  EXPECT_GT(cv::countNonZero(registration.process(frame).depth), 0);
}

TEST_F(EveryKernel, OfPreprocessing) {
  DepthPreprocessor preprocessor(compute, smallParameters().preprocessing, kCamera);
  RgbdFrame frame = roomFrame(0);
  frame.weights = cv::Mat(frame.depth.size(), CV_32FC1, cv::Scalar(0.5));
  preprocessor.process(frame, someVelocity());
  PreprocessingParameters corrected = smallParameters().preprocessing;
  corrected.depth_offsets_per_m = "2 2 0.01 0.01 0.01 0.01";
  preprocessor.setParameters(corrected, {});
  preprocessor.process(frame);
  frame.depth.convertTo(frame.depth, CV_16UC1, 1000.0);
  frame.depth_unit_m = 0.001;
  frame.weights = cv::Mat();
  const DepthLevel& coarsest = preprocessor.process(frame).levels.back();
  EXPECT_GT(cv::countNonZero(readImage(coarsest.depth, coarsest.camera)), 0);
}

TEST_F(EveryKernel, OfTrackingFusionColourAndViews) {
  ReconstructionPipeline pipeline(compute, smallParameters(), kCamera);
  for (int i = 0; i < 2; ++i) {
    const FrameResult result = pipeline.processFrame(roomFrame(i));
    EXPECT_NE(result.tracking.status, TrackingStatus::kLost) << result.tracking.reason;
    EXPECT_TRUE(result.color.fused) << result.color.reason;
  }
  StageTimers timers;
  ModelViewRenderer renderer(compute, pipeline.map(), kCamera);
  renderer.render(Pose::Identity(), 0.3f, 5.0f, timers);
  EXPECT_GT(cv::sum(renderer.shadedPicture())[0], 0.0);
  EXPECT_GT(cv::sum(renderer.coloredPicture())[0], 0.0);
  ModelViewRenderer mesh_renderer(compute, pipeline.map(), kCamera, {"marching_cubes"});
  const ModelView& view = mesh_renderer.render(Pose::Identity(), 0.3f, 5.0f, timers);
  EXPECT_GT(cv::countNonZero(readImage(view.depth, kCamera)), 0);
  TriangleMesh mesh;
  exportSurfaceMesh(compute, pipeline.map(), mesh);
  EXPECT_FALSE(mesh.triangles.empty());
}

TEST_F(EveryKernel, OfFusionByEveryRuleAndDistance) {
  const PipelineParameters parameters = coarseParameters();
  DepthPreprocessor preprocessor(compute, parameters.preprocessing, kCamera);
  const DepthFrame& depth = preprocessor.process(roomFrame(0));
  for (const std::string rule : {"kalman", "weighted", "average"}) {
    for (const std::string distance : {"projective", "plane", "refined"}) {
      BlockMap map(compute, parameters.map);
      TsdfFusionParameters fusion_parameters;
      fusion_parameters.rule = rule;
      fusion_parameters.distance = distance;
      TsdfFusion fusion(compute, map, fusion_parameters);
      StageTimers timers;
      EXPECT_GT(fusion.integrate(depth, Pose::Identity(), timers).blocks_updated, 0u);
    }
  }
}

TEST_F(EveryKernel, OfFusionIntoLargeBlocks) {
  PipelineParameters parameters = coarseParameters();
  parameters.map.block_size = 16;
  BlockMap map(compute, parameters.map);
  DepthPreprocessor preprocessor(compute, parameters.preprocessing, kCamera);
  TsdfFusion fusion(compute, map, TsdfFusionParameters());
  StageTimers timers;
  EXPECT_GT(fusion.integrate(preprocessor.process(roomFrame(0)), Pose::Identity(), timers).blocks_updated,
            0u);
}

TEST_F(EveryKernel, OfAMapThatIsFull) {
  MapParameters parameters = smallParameters().map;
  parameters.block_size = 32;
  BlockMap map(compute, parameters);
  std::vector<BlockIndex> blocks;
  for (int y = -4; y < 4; ++y) {
    for (int x = -4; x < 4; ++x) blocks.emplace_back(x, y, 0);
  }
  EXPECT_EQ(map.allocate(blocks), map.usage().capacity);
  EXPECT_LT(map.usage().capacity, blocks.size());
}

TEST_F(EveryKernel, OfBlocksThatComeAndGo) {
  BlockMap map(compute, smallParameters().map);
  const std::vector<int> slots = map.insert({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  map.setVoxels(kTsdfLayer, slots, map.voxels(kTsdfLayer, slots));
  map.evict(slots);
  EXPECT_EQ(map.usage().blocks, 0u);
}

TEST_F(EveryKernel, OfTheDistanceField) {
  const PipelineParameters parameters = coarseParameters();
  BlockMap map(compute, parameters.map);
  EsdfParameters cells;
  cells.voxel_size_m = 0.4f;
  Esdf esdf(compute, map, cells);
  DepthPreprocessor preprocessor(compute, parameters.preprocessing, kCamera);
  TsdfFusion fusion(compute, map, TsdfFusionParameters());
  StageTimers timers;
  const DepthFrame& depth = preprocessor.process(roomFrame(0));
  fusion.integrate(depth, Pose::Identity(), timers);
  esdf.readMap(timers);
  esdf.see(depth, Pose::Identity(), timers);
  EXPECT_FALSE(esdf.update(timers).empty());
}

TEST_F(EveryKernel, OfAListOfRequestsThatIsFull) {
  constexpr int kCapacity = 4;
  const PipelineParameters parameters = smallParameters();
  BlockMap map(compute, parameters.map);
  DepthPreprocessor preprocessor(compute, parameters.preprocessing, kCamera);
  DeviceBuffer requests(compute, kCapacity * sizeof(BlockRequest), "requests");
  DeviceBuffer count(compute, sizeof(int), "count"), points_outside(compute, sizeof(int), "count");
  count.fill(0, sizeof(int));
  points_outside.fill(0, sizeof(int));
  TsdfFusion::Kernels(compute, map)
      .requestBlocks(preprocessor.process(roomFrame(0)), map, requests, count, points_outside,
                     Pose::Identity(), {1, 0.0f, 5, kCapacity});
  EXPECT_GT(count.read<int>(1).front(), kCapacity);
}

}  // namespace
}  // namespace depth_fusion
