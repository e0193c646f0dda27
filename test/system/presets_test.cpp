// Every preset in cfg/ loads, and maps the simulated room through its own sensor's noise.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>

#include "depth_fusion/pipeline/reconstruction_pipeline.h"
#include "depth_fusion/surface_mesh/surface_mesh.h"
#include "tools/evaluation/mesh_error.h"
#include "tools/evaluation/trajectory_error.h"
#include "tools/simulation/simulated_recording.h"

namespace depth_fusion {
namespace {

constexpr float kRoomNeeds_m = 2.5f;  // of a sensor's range

std::vector<std::string> presets() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator("cfg")) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

// Depth with the noise that the preset says the sensor has.
SensorModel sensorOf(const PipelineParameters& preset) {
  SensorModel sensor;
  sensor.min_range_m = preset.preprocessing.min_range_m;
  sensor.max_range_m = preset.preprocessing.max_range_m;
  sensor.sigma_base_m = preset.depth_sensor.sigma_base_m;
  sensor.sigma_growth_per_m = preset.depth_sensor.sigma_growth_per_m;
  sensor.sigma_from_m = preset.depth_sensor.sigma_from_m;
  sensor.lateral_sigma_px = 0.5 * preset.depth_sensor.lateral_sigma_px;
  sensor.edge_dropout = 0.5;
  sensor.grazing_cos = 0.2;
  return sensor;
}

class Presets : public testing::TestWithParam<std::string> {
 protected:
  PipelineParameters load() const {
    PipelineParameters parameters;
    loadParameterFile(parameters.table(), "cfg/" + GetParam() + ".yaml");
    return parameters;
  }
};

TEST_P(Presets, LoadAndFitTogether) {
  PipelineParameters parameters = load();
  validate(parameters.table());
  validateRange(parameters.preprocessing, parameters.depth_sensor);
}

TEST_P(Presets, MapTheRoom) {
  constexpr int kFrames = 30;
  PipelineParameters parameters = load();
  if (parameters.preprocessing.max_range_m < kRoomNeeds_m) GTEST_SKIP() << "it is for close range";
  parameters.map.voxel_size_m = 0.01f;  // of a coarser image than the sensor's
  parameters.preprocessing.readout_s = parameters.preprocessing.stamp_delay_s =
      0.0f;  // the simulated shutter is global
  SimulationOptions options;
  options.intrinsics = {320, 240, 262.5, 262.5, 159.5, 119.5};
  const SimulatedRecording room(options);
  ComputeContext compute;
  ReconstructionPipeline pipeline(compute, parameters, options.intrinsics);
  Trajectory estimate, truth;
  for (int i = 0; i < kFrames; ++i) {
    const StampedPose pose = room.poseOf(i);
    const RenderedView view = render(room.scene().surface, options.intrinsics, pose.T_W_D);
    RgbdFrame frame;
    frame.stamp_s = pose.stamp_s;
    frame.depth = senseDepth(view, sensorOf(parameters), static_cast<uint64_t>(i));
    frame.color = view.color;
    frame.intrinsics = options.intrinsics;
    const TrackingResult tracking = pipeline.processFrame(frame).tracking;
    ASSERT_NE(tracking.status, TrackingStatus::kLost) << tracking.reason;
    estimate.push_back({pose.stamp_s, tracking.T_W_D});
    truth.push_back(pose);
  }
  TriangleMesh mesh;
  exportSurfaceMesh(compute, pipeline.map(), mesh, parameters.surface_mesh);
  const MeshError error = compareMesh(mesh, truth.front().T_W_D, room.scene().surface);
  const double ate_m = compareTrajectories(estimate, truth).ate_m.rmse;
  std::printf("ATE %.2f mm, %.1f m^2 of mesh: mean %.2f mm, 95 %% %.2f mm\n", 1e3 * ate_m, error.area_m2,
              1e3 * error.surface_m.mean, 1e3 * error.surface_m.percentile95);
  EXPECT_LT(ate_m, 0.005);
  EXPECT_GT(error.area_m2, 3.0);
  EXPECT_LT(error.surface_m.mean, 0.004);
}

INSTANTIATE_TEST_SUITE_P(Cfg, Presets, testing::ValuesIn(presets()),
                         [](const testing::TestParamInfo<std::string>& info) { return info.param; });

}  // namespace
}  // namespace depth_fusion
