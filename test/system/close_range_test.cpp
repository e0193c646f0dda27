// Small things at close range: a precision scanner's seal in voxels of 0.15 mm, and a world that is a
// sixteenth of the size.
#include <gtest/gtest.h>

#include <cstdio>

#include "shared/types.h"
#include "support/map_contents.h"
#include "support/synthetic_fusion.h"
#include "support/test_compute.h"
#include "tools/evaluation/trajectory_error.h"

namespace depth_fusion {
namespace {

constexpr double kMostBytes = 1.5e9;
constexpr float kShrink = 1.0f / 16.0f;  // a power of two, that rounding is alike

PipelineParameters scannerParameters() {
  PipelineParameters parameters;
  loadParameterFile(parameters.table(), "cfg/precision_scanner.yaml");
  return parameters;
}

struct Scan {
  Reconstruction result;
  TrajectoryError trajectory;
  MeshError mesh;
};

// From beside the face to where it hides all else, at 2.4 times the hand's speed.
Scan scanSeal(const PipelineParameters& parameters) {
  SimulationOptions options;
  options.scene = "seal";
  options.frames = 45;
  options.speed = 2.4;
  SimulatedRecording recording(options);
  Scan scan;
  scan.result = reconstruct(compute(), recording, parameters, Poses::kTracked);
  scan.trajectory = compareTrajectories(scan.result.estimate, scan.result.truth);
  scan.mesh = compareMesh(scan.result.mesh, scan.result.T_W_M, recording.scene().surface);
  std::printf(
      "%zu lost, ATE %.4f mm, mesh of %.1f cm^2: mean %.4f mm, 95 %% %.4f mm; %zu MB, %zu MB allocated\n",
      scan.result.lost, 1e3 * scan.trajectory.ate_m.rmse, 1e4 * scan.mesh.area_m2,
      1e3 * scan.mesh.surface_m.mean, 1e3 * scan.mesh.surface_m.percentile95,
      scan.result.usage.bytes / 1000000, scan.result.usage.pool_bytes / 1000000);
  return scan;
}

TEST(CloseRange, a_seal_is_scanned_to_five_hundredths_of_a_millimetre) {
  const PipelineParameters parameters = scannerParameters();
  EXPECT_EQ(parameters.map.blocks_per_axis * parameters.map.block_size, 4096);
  EXPECT_FLOAT_EQ(parameters.map.voxel_size_m, 0.00015f);
  const Scan scan = scanSeal(parameters);
  EXPECT_EQ(scan.result.lost, 0u);
  EXPECT_LE(scan.trajectory.ate_m.rmse, 0.0001);
  EXPECT_GE(scan.mesh.area_m2, 0.003);
  EXPECT_LE(scan.mesh.surface_m.mean, 0.00005);
  EXPECT_LE(scan.mesh.surface_m.percentile95, 0.00015);
  EXPECT_LE(static_cast<double>(scan.result.usage.pool_bytes), kMostBytes);
}

TEST(CloseRange, without_texture_the_flat_face_is_not_followed) {
  PipelineParameters parameters = scannerParameters();
  parameters.texture_odometry.enabled = false;
  const Scan scan = scanSeal(parameters);
  EXPECT_TRUE(scan.result.lost > 0 || scan.trajectory.ate_m.rmse > 0.001)
      << "the control must fail, or the test above shows nothing";
}

struct RoomRun {
  Trajectory estimate;
  MapContent map;
};

// The room as it is, or with all its lengths and those among the parameters times `scale`.
RoomRun runRoom(float scale) {
  PipelineParameters parameters;
  for (const Parameter& parameter : parameters.table()) {
    float* const* value = std::get_if<float*>(&parameter.value);
    const auto endsWith = [&](const std::string& suffix) {
      return parameter.name.size() > suffix.size() &&
             parameter.name.compare(parameter.name.size() - suffix.size(), suffix.size(), suffix) == 0;
    };
    if (value != nullptr && endsWith("_m")) **value *= endsWith("_per_m") ? 1.0f / scale : scale;
  }
  SimulationOptions options;
  options.frames = 3;  // later, other rounding has grown to tracking's noise
  options.fps = 15.0;
  options.intrinsics = halved(kinectSensor().camera);
  SimulatedRecording recording(options);
  ReconstructionPipeline pipeline(compute(), parameters, options.intrinsics);
  RoomRun run;
  while (std::optional<RgbdFrame> frame = recording.next()) {
    frame->depth *= scale;
    const TrackingResult tracking = pipeline.processFrame(*frame).tracking;
    EXPECT_EQ(tracking.status, TrackingStatus::kTracking) << tracking.reason;
    run.estimate.push_back({frame->stamp_s, tracking.T_W_D});
  }
  run.map = readMap(pipeline.map());
  return run;
}

double meanCertainty(const MapContent& map) {
  double sum = 0.0, known = 0.0;
  for (const auto& [key, block] : map) {
    for (size_t i = 0; i < block.distances.size(); ++i) {
      if (block.distances[i] == TSDF_CHI) continue;
      sum += block.certainties[i];
      ++known;
    }
  }
  return sum / known;
}

TEST(CloseRange, a_small_world_is_tracked_and_fused_as_a_large_one) {
  const RoomRun large = runRoom(1.0f), small = runRoom(kShrink);
  for (size_t i = 0; i < large.estimate.size(); ++i) {
    Pose enlarged = small.estimate[i].T_W_D;
    enlarged.translation() /= kShrink;
    const Pose difference = large.estimate[i].T_W_D.inverse() * enlarged;
    EXPECT_LE(difference.translation().norm(), 0.00001) << i;
    EXPECT_LE(rotationAngle(difference), 0.00001) << i;
  }
  EXPECT_NEAR(small.map.size(), large.map.size(), 0.02 * large.map.size());
  EXPECT_NEAR(meanCertainty(small.map), meanCertainty(large.map), 0.5);
}

}  // namespace
}  // namespace depth_fusion
