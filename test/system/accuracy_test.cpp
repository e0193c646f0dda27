// How accurate whole runs are, measured against the exact surface and poses of the simulated scenes.
#include <gtest/gtest.h>

#include <cstdio>

#include "support/synthetic_fusion.h"
#include "tools/evaluation/trajectory_error.h"

namespace depth_fusion {
namespace {

MeshError meshError(const Reconstruction& result, const SimulatedRecording& recording) {
  const MeshError error = compareMesh(result.mesh, result.T_W_M, recording.scene().surface);
  std::printf("mesh of %.2f m^2: mean %.3f mm, 95 %% %.3f mm\n", error.area_m2, 1000.0 * error.surface_m.mean,
              1000.0 * error.surface_m.percentile95);
  return error;
}

TrajectoryError trajectoryError(const Reconstruction& result) {
  const TrajectoryError error = compareTrajectories(result.estimate, result.truth);
  std::printf("trajectory of %zu poses: ATE %.2f mm\n", error.pairs.size(), 1000.0 * error.ate_m.rmse);
  return error;
}

// Three times the scene's own speed: much of it in few frames.
SimulationOptions simulation(const std::string& scene, int frames, bool noise) {
  SimulationOptions options;
  options.speed = 3.0;
  options.scene = scene;
  options.frames = frames;
  options.noise = noise;
  return options;
}

// For objects at arm's length: voxels of half a millimetre.
PipelineParameters closeRange() {
  PipelineParameters parameters;
  parameters.map.voxel_size_m = 0.0005f;
  parameters.map.truncation_m = 0.002f;
  parameters.preprocessing.min_range_m = 0.15f;
  parameters.preprocessing.max_range_m = 0.8f;
  return parameters;
}

TEST(Accuracy, room_without_noise_at_given_poses) {
  ComputeContext compute;
  SimulatedRecording recording(simulation("room", 60, false));
  const Reconstruction result = reconstruct(compute, recording, {}, Poses::kGiven);
  const MeshError error = meshError(result, recording);
  EXPECT_GT(error.area_m2, 10.0);
  EXPECT_LE(error.surface_m.mean, 0.0005);
  EXPECT_LE(error.surface_m.percentile95, 0.0015);
}

TEST(Accuracy, room_with_noise_tracked) {
  ComputeContext compute;
  SimulatedRecording recording(simulation("room", 100, true));
  const Reconstruction result = reconstruct(compute, recording, {}, Poses::kTracked);
  EXPECT_EQ(result.lost, 0u);
  EXPECT_LE(trajectoryError(result).ate_m.rmse, 0.010);
  const MeshError error = meshError(result, recording);
  EXPECT_LE(error.surface_m.mean, 0.002);
  EXPECT_LE(error.surface_m.percentile95, 0.006);
}

TEST(Accuracy, close_range_object_with_noise_tracked) {
  ComputeContext compute;
  SimulatedRecording recording(simulation("object", 60, true));
  const Reconstruction result = reconstruct(compute, recording, closeRange(), Poses::kTracked);
  EXPECT_EQ(result.lost, 0u);
  EXPECT_LE(trajectoryError(result).ate_m.rmse, 0.0005);
  const MeshError error = meshError(result, recording);
  EXPECT_GT(error.area_m2, 0.25);
  EXPECT_LE(error.surface_m.mean, 0.0002);
  EXPECT_LE(error.surface_m.percentile95, 0.0005);
}

}  // namespace
}  // namespace depth_fusion
