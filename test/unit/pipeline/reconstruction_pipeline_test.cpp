#include "depth_fusion/pipeline/reconstruction_pipeline.h"

#include <gtest/gtest.h>

#include <cstring>

#include "depth_fusion/pipeline/warm_up.h"
#include "depth_fusion/surface_mesh/surface_mesh.h"
#include "depth_fusion/surface_mesh/triangle_mesh.h"
#include "support/expect_error.h"
#include "support/map_contents.h"
#include "support/room_frames.h"
#include "support/test_compute.h"
#include "tools/simulation/simulated_recording.h"

namespace depth_fusion {
namespace {

constexpr CameraIntrinsics kCamera{160, 120, 131.25, 131.25, 79.5, 59.5};
constexpr int kFrames = 12;

const std::vector<RgbdFrame>& roomFrames() {
  static const std::vector<RgbdFrame> frames = simulateRoom(kCamera, kFrames);
  return frames;
}

RgbdFrame frameWithoutDepth() {
  RgbdFrame frame = roomFrames()[0];
  frame.depth = frame.depth.clone();
  frame.depth.setTo(0.0);
  return frame;
}

// The pose of frame i in the camera frame of the first one.
Pose motionTo(int i) { return roomFrames()[0].T_W_D->inverse() * *roomFrames()[i].T_W_D; }

bool isTracking(const FrameResult& result) { return result.tracking.status == TrackingStatus::kTracking; }

void expectLost(const FrameResult& result, const std::string& reason) {
  EXPECT_EQ(result.tracking.status, TrackingStatus::kLost);
  EXPECT_NE(result.tracking.reason.find(reason), std::string::npos) << result.tracking.reason;
  EXPECT_EQ(result.fusion.blocks_updated, 0u);
}

TriangleMesh meshOf(ReconstructionPipeline& pipeline) {
  TriangleMesh mesh;
  exportSurfaceMesh(compute(), pipeline.map(), mesh);
  return mesh;
}

bool sameBytes(const TriangleMesh& a, const TriangleMesh& b) {
  return a.triangles == b.triangles && a.vertices.size() == b.vertices.size() &&
         std::memcmp(a.vertices.data(), b.vertices.data(), a.vertices.size() * sizeof(MeshVertex)) == 0;
}

void expectRoomTracked(const PipelineParameters& parameters) {
  ReconstructionPipeline pipeline(compute(), parameters, kCamera);
  for (int i = 0; i < kFrames; ++i) {
    const FrameResult result = pipeline.processFrame(roomFrames()[i]);
    ASSERT_TRUE(isTracking(result)) << i << " " << result.tracking.reason;
    EXPECT_GT(result.fusion.blocks_updated, 0u);
    const Pose error = motionTo(i).inverse() * result.tracking.T_W_D;
    EXPECT_LT(error.translation().norm(), 0.015) << i;
    EXPECT_LT(rotationAngle(error), 0.01) << i;
  }
  EXPECT_GT(meshOf(pipeline).triangles.size(), 5000u);
}

TEST(ReconstructionPipeline, TracksAndFusesTheRoom) { expectRoomTracked(coarseRoomParameters()); }

TEST(ReconstructionPipeline, TracksAgainstViewsOfHalfTheSize) {
  PipelineParameters parameters = coarseRoomParameters();
  parameters.model_view.half_size = true;
  expectRoomTracked(parameters);
}

TEST(ReconstructionPipeline, StartsWithTheFirstFrameThatHasDepth) {
  ReconstructionPipeline pipeline(compute(), coarseRoomParameters(), kCamera);
  for (int i = 0; i < 3; ++i)
    expectLost(pipeline.processFrame(frameWithoutDepth()), "only 0 points with depth in range");
  EXPECT_EQ(pipeline.map().usage().blocks, 0u);
  const FrameResult first = pipeline.processFrame(roomFrames()[0]);
  ASSERT_TRUE(isTracking(first));
  EXPECT_TRUE(first.tracking.T_W_D.isApprox(Pose::Identity()));
  const FrameResult second = pipeline.processFrame(roomFrames()[1]);
  EXPECT_TRUE(isTracking(second)) << second.tracking.reason;
}

TEST(ReconstructionPipeline, LostFrameChangesNothingAndTheNextIsTracked) {
  ReconstructionPipeline pipeline(compute(), coarseRoomParameters(), kCamera);
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(isTracking(pipeline.processFrame(roomFrames()[i])));
  const MapContent before = readMap(pipeline.map());
  ASSERT_GT(before.size(), 100u);

  expectLost(pipeline.processFrame(frameWithoutDepth()), "no points with depth");
  EXPECT_TRUE(readMap(pipeline.map()) == before);
  RgbdFrame turned = roomFrames()[3];
  turned.depth = turned.depth.clone();
  cv::flip(roomFrames()[3].depth, turned.depth, -1);
  expectLost(pipeline.processFrame(turned), "");
  EXPECT_TRUE(readMap(pipeline.map()) == before);

  EXPECT_TRUE(isTracking(pipeline.processFrame(roomFrames()[3])));
  EXPECT_FALSE(readMap(pipeline.map()) == before);
}

TEST(ReconstructionPipeline, TracksOnFromAPoseThatWasGiven) {
  PipelineParameters parameters = coarseRoomParameters();
  parameters.map.blocks_per_axis = 256;
  ReconstructionPipeline pipeline(compute(), parameters, kCamera);
  ASSERT_TRUE(isTracking(pipeline.processFrame(roomFrames()[0])));
  Pose T_W_D = Pose::Identity();
  T_W_D.translation().x() = 7.0;
  ASSERT_GT(pipeline.processFrame(roomFrames()[0], T_W_D).fusion.blocks_updated, 0u);
  // Against the view from before it is lost; then it is looked for where the pose was given.
  FrameResult result;
  for (int i = 0; i < 2; ++i) result = pipeline.processFrame(roomFrames()[0]);
  ASSERT_TRUE(isTracking(result)) << result.tracking.reason;
  EXPECT_LT((result.tracking.T_W_D.translation() - T_W_D.translation()).norm(), 0.015);
}

// Tracks for a second, and follows poses for another that are off by so much. Returns the doubt about the
// map.
std::string doubtAfterPosesThatAreOff(const Eigen::Vector3d& off_m) {
  const std::vector<RgbdFrame> frames = simulateRoom(kCamera, 60);
  ReconstructionPipeline pipeline(compute(), coarseRoomParameters(), kCamera);
  FrameResult result;
  for (int i = 0; i < 30; ++i) result = pipeline.processFrame(frames[i]);
  EXPECT_TRUE(isTracking(result)) << result.tracking.reason;
  for (int i = 30; i < 60; ++i) {
    const Pose T_W_D = frames[0].T_W_D->inverse() * *frames[i].T_W_D * Eigen::Translation3d(off_m);
    result = pipeline.processFrame(frames[i], T_W_D);
  }
  return result.tracking.map_doubt;
}

TEST(ReconstructionPipeline, GivenPosesThatAreWrongForASecondAreNoticed) {
  EXPECT_EQ(doubtAfterPosesThatAreOff({0.0, 0.0, 0.0}), "");
  for (const Eigen::Vector3d& off_m : {Eigen::Vector3d(0.12, 0.0, 0.0), Eigen::Vector3d(0.0, 0.0, -0.12)}) {
    const std::string doubt = doubtAfterPosesThatAreOff(off_m);
    EXPECT_NE(doubt.find("as it was seen before"), std::string::npos) << doubt;
  }
}

// Covered for a second, then back where it was a while before: keyframes say where that is.
TEST(ReconstructionPipeline, ComesBackAfterABlackoutAndAJump) {
  SimulationOptions options;
  options.frames = 60;
  options.speed = 2.0;
  options.intrinsics = {320, 240, 262.5, 262.5, 159.5, 119.5};
  std::vector<RgbdFrame> frames;
  SimulatedRecording recording(options);
  while (std::optional<RgbdFrame> frame = recording.next()) frames.push_back(std::move(*frame));
  RgbdFrame black = frames.back();
  for (cv::Mat* image : {&black.depth, &black.color})
    *image = cv::Mat(image->size(), image->type(), cv::Scalar::all(0));

  ReconstructionPipeline pipeline(compute(), coarseRoomParameters(), options.intrinsics);
  for (const RgbdFrame& frame : frames) {
    const FrameResult result = pipeline.processFrame(frame);
    ASSERT_TRUE(isTracking(result)) << frame.stamp_s << " " << result.tracking.reason;
  }
  EXPECT_GT(pipeline.keyframeCount(), 2u);
  const MapContent before = readMap(pipeline.map());
  for (int i = 0; i < 30; ++i) expectLost(pipeline.processFrame(black), "no points with depth");
  EXPECT_TRUE(readMap(pipeline.map()) == before);

  const Pose jump = frames.back().T_W_D->inverse() * *frames[2].T_W_D;
  ASSERT_GT(jump.translation().norm() + rotationAngle(jump), 0.5) << "out of reach of ICP alone";
  const FrameResult back = pipeline.processFrame(frames[2]);
  ASSERT_TRUE(isTracking(back)) << back.tracking.reason;
  const Pose error = (frames[0].T_W_D->inverse() * *frames[2].T_W_D).inverse() * back.tracking.T_W_D;
  EXPECT_LT(error.translation().norm(), 0.01);
  EXPECT_LT(rotationAngle(error), 0.01);
  EXPECT_GT(back.fusion.blocks_updated, 0u);
}

std::vector<RgbdFrame> framesOf(const std::string& scene, int count) {
  SimulationOptions options;
  options.scene = scene;
  options.frames = count;
  options.intrinsics = kCamera;
  std::vector<RgbdFrame> frames;
  SimulatedRecording recording(options);
  while (std::optional<RgbdFrame> frame = recording.next()) frames.push_back(std::move(*frame));
  return frames;
}

// Another place looks like none of the keyframes: lost it stays.
TEST(ReconstructionPipeline, StaysLostInAnotherPlace) {
  ReconstructionPipeline pipeline(compute(), coarseRoomParameters(), kCamera);
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(isTracking(pipeline.processFrame(roomFrames()[i])));
  const MapContent before = readMap(pipeline.map());
  for (const RgbdFrame& frame : framesOf("cylinder", 12)) expectLost(pipeline.processFrame(frame), "");
  EXPECT_TRUE(readMap(pipeline.map()) == before);
}

TEST(ReconstructionPipeline, AMapOfAFewFramesThatNothingFitsBeginsAnew) {
  PipelineParameters parameters = coarseRoomParameters();
  parameters.relocalisation.young_map_frames = 3;
  parameters.relocalisation.give_up_after_frames = 4;
  ReconstructionPipeline pipeline(compute(), parameters, kCamera);
  FrameResult last;
  for (int i = 0; i < 3; ++i) last = pipeline.processFrame(roomFrames()[i]);
  ASSERT_TRUE(isTracking(last)) << last.tracking.reason;
  const uint32_t generation = pipeline.map().generation();

  const std::vector<RgbdFrame> frames = framesOf("cylinder", 12);
  for (int i = 0; i < 4; ++i) {
    expectLost(pipeline.processFrame(frameWithoutDepth()), "");  // says nothing about the map
    expectLost(pipeline.processFrame(frames[i]), "");
  }
  EXPECT_EQ(pipeline.map().generation(), generation);
  const FrameResult first = pipeline.processFrame(frames[4]);
  ASSERT_EQ(first.tracking.status, TrackingStatus::kDegenerate) << first.tracking.reason;
  EXPECT_EQ(first.tracking.guessed_directions, 6) << "where the new map is in the world, nothing measures";
  EXPECT_NE(first.tracking.reason.find("begins anew"), std::string::npos) << first.tracking.reason;
  EXPECT_NE(pipeline.map().generation(), generation);
  EXPECT_LT((last.tracking.T_W_D.inverse() * first.tracking.T_W_D).translation().norm(), 0.2)
      << "goes on where the sensor is expected";
  for (int i = 5; i < 12; ++i) {
    const FrameResult result = pipeline.processFrame(frames[i]);
    EXPECT_NE(result.tracking.status, TrackingStatus::kLost) << i << " " << result.tracking.reason;
  }
}

TEST(ReconstructionPipeline, AMapOfManyFramesStays) {
  PipelineParameters parameters = coarseRoomParameters();
  parameters.relocalisation.young_map_frames = 3;
  parameters.relocalisation.give_up_after_frames = 4;
  ReconstructionPipeline pipeline(compute(), parameters, kCamera);
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(isTracking(pipeline.processFrame(roomFrames()[i])));
  for (const RgbdFrame& frame : framesOf("cylinder", 8)) expectLost(pipeline.processFrame(frame), "");
}

// Without texture nothing says how the sensor moves along it: a few frames are guessed, and then it is lost.
TEST(ReconstructionPipeline, BeforeABareWallTheSensorIsLost) {
  PipelineParameters parameters = coarseRoomParameters();
  parameters.texture_odometry.enabled = false;
  ReconstructionPipeline pipeline(compute(), parameters, kCamera);
  const std::vector<RgbdFrame> frames = framesOf("wall", 12);
  EXPECT_TRUE(isTracking(pipeline.processFrame(frames[0])));
  const TrackingResult guessed = pipeline.processFrame(frames[1]).tracking;
  EXPECT_EQ(guessed.status, TrackingStatus::kDegenerate) << guessed.smallest_eigenvalue;
  EXPECT_GT(guessed.guessed_directions, 0);
  EXPECT_NE(guessed.reason.find("nothing measures that"), std::string::npos) << guessed.reason;
  int i = 2;
  FrameResult result = pipeline.processFrame(frames[i]);
  while (result.tracking.status == TrackingStatus::kDegenerate && i < 8)
    result = pipeline.processFrame(frames[++i]);
  EXPECT_GT(i, 2);
  expectLost(result, "too far to go on");
  while (++i < 12) expectLost(pipeline.processFrame(frames[i]), "");
}

TEST(ReconstructionPipeline, TheSameFramesGiveTheSameBits) {
  ReconstructionPipeline a(compute(), coarseRoomParameters(), kCamera);
  ReconstructionPipeline b(compute(), coarseRoomParameters(), kCamera);
  for (const RgbdFrame& frame : roomFrames()) {
    const FrameResult result_a = a.processFrame(frame);
    const FrameResult result_b = b.processFrame(frame);
    ASSERT_TRUE(result_a.tracking.T_W_D.matrix() == result_b.tracking.T_W_D.matrix());
    ASSERT_EQ(result_a.fusion.blocks_updated, result_b.fusion.blocks_updated);
  }
  EXPECT_TRUE(readMap(a.map()) == readMap(b.map()));
  EXPECT_TRUE(sameBytes(meshOf(a), meshOf(b)));
}

// The room, with a frame in between that is lost.
std::vector<RgbdFrame> framesWithALoss() {
  std::vector<RgbdFrame> frames = roomFrames();
  frames[6].depth = frameWithoutDepth().depth;
  return frames;
}

// A near and a far wall, between which the window of a map of 2.5 m finds nothing.
RgbdFrame frameOutsideOfTheWindow() {
  RgbdFrame frame = roomFrames()[0];
  frame.stamp_s = -1.0 / 30.0;
  frame.depth = cv::Mat(frame.depth.size(), frame.depth.type());
  frame.depth.colRange(0, kCamera.width / 2) = 0.5 / frame.depth_unit_m;
  frame.depth.colRange(kCamera.width / 2, kCamera.width) = 4.5 / frame.depth_unit_m;
  return frame;
}

// Each frame's results and the maps are the same whether the next frame is announced or not.
void expectSameOverlapped(const PipelineParameters& parameters, const std::vector<RgbdFrame>& frames) {
  ReconstructionPipeline sequential(compute(), parameters, kCamera);
  ReconstructionPipeline overlapped(compute(), parameters, kCamera);
  for (size_t i = 0; i < frames.size(); ++i) {
    const FrameResult a = sequential.processFrame(frames[i]);
    const FrameResult b =
        overlapped.processFrame(frames[i], i + 1 < frames.size() ? &frames[i + 1] : nullptr);
    ASSERT_EQ(a.tracking.status, b.tracking.status) << i;
    ASSERT_EQ(a.tracking.reason, b.tracking.reason) << i;
    ASSERT_EQ(a.tracking.prior, b.tracking.prior) << i;
    ASSERT_TRUE(a.tracking.T_W_D.matrix() == b.tracking.T_W_D.matrix()) << i;
    ASSERT_EQ(a.fusion.blocks_updated, b.fusion.blocks_updated) << i;
    ASSERT_EQ(sequential.keyframeCount(), overlapped.keyframeCount()) << i;
  }
  EXPECT_GT(sequential.map().usage().blocks, 0u);
  EXPECT_TRUE(readMap(sequential.map()) == readMap(overlapped.map()));
}

TEST(ReconstructionPipeline, OverlappedFramesGiveTheSameBits) {
  PipelineParameters parameters = coarseRoomParameters();
  parameters.preprocessing.readout_s = 0.03f;
  expectSameOverlapped(parameters, framesWithALoss());
  parameters.texture_odometry.enabled = false;
  expectSameOverlapped(parameters, framesWithALoss());
}

TEST(ReconstructionPipeline, OverlappedFramesGiveTheSameBitsAfterOneThatIsNotFused) {
  PipelineParameters parameters = coarseRoomParameters();
  parameters.map.blocks_per_axis = 16;
  parameters.preprocessing.readout_s = 0.03f;
  std::vector<RgbdFrame> frames = roomFrames();
  frames.insert(frames.begin(), frameOutsideOfTheWindow());
  ReconstructionPipeline pipeline(compute(), parameters, kCamera);
  expectLost(pipeline.processFrame(frames.front()), "window");
  EXPECT_EQ(pipeline.keyframeCount(), 0u);
  expectSameOverlapped(parameters, frames);
}

TEST(ReconstructionPipeline, OnlyTheAnnouncedFrameMayComeNext) {
  const std::vector<RgbdFrame>& frames = roomFrames();
  ReconstructionPipeline pipeline(compute(), coarseRoomParameters(), kCamera);
  pipeline.processFrame(frames[0], &frames[1]);
  expectError([&] { pipeline.processFrame(frames[2]); }, {"was announced", "came"});
  expectError([&] { pipeline.processFrame(frames[1], *frames[1].T_W_D); }, {"was announced", "has not come"});
  const FrameResult announced = pipeline.processFrame(frames[1]);
  ASSERT_TRUE(isTracking(announced)) << announced.tracking.reason;
  EXPECT_LT((motionTo(1).inverse() * announced.tracking.T_W_D).translation().norm(), 0.015);
  EXPECT_TRUE(isTracking(pipeline.processFrame(frames[2], *frames[2].T_W_D)));
}

TEST(ReconstructionPipeline, FusesWithGivenPoses) {
  const SimulatedScene scene = makeScene("room");
  ReconstructionPipeline pipeline(compute(), coarseRoomParameters(), kCamera);
  expectLost(pipeline.processFrame(frameWithoutDepth(), *roomFrames()[0].T_W_D), "no depth in range");
  for (const RgbdFrame& frame : roomFrames()) {
    const FrameResult result = pipeline.processFrame(frame, *frame.T_W_D);
    ASSERT_TRUE(isTracking(result));
    EXPECT_TRUE(result.tracking.T_W_D.matrix() == frame.T_W_D->matrix());
  }
  const TriangleMesh mesh = meshOf(pipeline);
  ASSERT_GT(mesh.vertices.size(), 5000u);
  double sum_m = 0.0;
  for (const MeshVertex& vertex : mesh.vertices) {
    sum_m += std::abs(scene.surface.distance(vertex.position_W.cast<double>()));
  }
  EXPECT_LT(sum_m / mesh.vertices.size(), 0.006);
}

TEST(ReconstructionPipeline, TableNamesEveryStagesParameters) {
  PipelineParameters parameters;
  const ParameterTable table = parameters.table();
  setParameter(table, "map/voxel_size_m", "0.0125");
  setParameter(table, "tsdf_fusion/max_weight", "17");
  setParameter(table, "icp_tracking/fine_iterations", "3");
  setParameter(table, "preprocessing/max_range_m", "2.5");
  setParameter(table, "surface_mesh/min_certainty", "4");
  EXPECT_EQ(parameters.map.voxel_size_m, 0.0125f);
  EXPECT_EQ(parameters.tsdf_fusion.max_weight, 17.0f);
  EXPECT_EQ(parameters.icp_tracking.fine_iterations, 3);
  EXPECT_EQ(parameters.preprocessing.max_range_m, 2.5f);
  EXPECT_EQ(parameters.surface_mesh.min_certainty, 4);
}

TEST(WarmUp, RunsWhateverTheParameters) {
  PipelineParameters parameters;
  warmUp(compute(), parameters);
  parameters.map.color = true;
  parameters.map.block_size = 16;
  parameters.model_view.renderer = "marching_cubes";
  parameters.preprocessing.min_range_m = 0.15f;
  parameters.preprocessing.max_range_m = 0.25f;
  parameters.preprocessing.readout_s = 0.03f;
  warmUp(compute(), parameters);
}

}  // namespace
}  // namespace depth_fusion
