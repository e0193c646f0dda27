#include "apps/benchmark/noise.h"

#include <cstdio>
#include <filesystem>
#include <iostream>

#include "apps/benchmark/tracking_inputs.h"
#include "common/io/text_file.h"
#include "depth_fusion/common/percentile.h"
#include "depth_fusion/surface_mesh/surface_mesh.h"
#include "tools/evaluation/mesh_error.h"
#include "tools/evaluation/trajectory_error.h"
#include "tools/simulation/simulated_recording.h"

namespace depth_fusion {
namespace {

constexpr int kNoisyFrames = 200;
constexpr float kFarVoxel_m = 0.005f;

struct NoiseRun {
  std::string name;
  PipelineParameters parameters;
  OpenRecording open;
  Trajectory truth;
  bool noise = true;
  unsigned seed = 1;
  const SimulatedScene* scene = nullptr;  // whose surface is known
};

double sigmaAt(const DepthSensorParameters& sensor, double z_m) {
  return sensor.sigma_base_m +
         sensor.sigma_growth_per_m * (z_m - sensor.sigma_from_m) * (z_m - sensor.sigma_from_m);
}

std::unique_ptr<Recording> recordingOf(const NoiseRun& run) {
  if (!run.noise) return run.open();
  return withNoise(run.open(), run.parameters.depth_sensor, run.parameters.depthRange(), run.seed);
}

double surfaceError_mm(ComputeContext& compute, ReconstructionPipeline& pipeline, const Pose& T_W_M,
                       const NoiseRun& run) {
  TriangleMesh mesh;
  exportSurfaceMesh(compute, pipeline.map(), mesh);
  return 1e3 * compareMesh(mesh, T_W_M, run.scene->surface).surface_m.mean;
}

double surfaceErrorAtGivenPoses_mm(ComputeContext& compute, const NoiseRun& run) {
  std::unique_ptr<ReconstructionPipeline> pipeline;
  const std::unique_ptr<Recording> recording = recordingOf(run);
  while (const std::optional<RgbdFrame> frame = recording->next()) {
    if (!pipeline)
      pipeline = std::make_unique<ReconstructionPipeline>(compute, run.parameters, frame->intrinsics);
    pipeline->processFrame(*frame, *frame->T_W_D);
  }
  return surfaceError_mm(compute, *pipeline, Pose::Identity(), run);
}

std::string surfaceOf(ComputeContext& compute, ReconstructionPipeline& pipeline, const NoiseRun& run) {
  if (run.scene == nullptr) return "";
  char text[100];
  std::snprintf(text, sizeof(text), "%.2f, %.2f (%.2f)",
                surfaceError_mm(compute, pipeline, run.truth.front().T_W_D, run),
                surfaceErrorAtGivenPoses_mm(compute, run),
                1e3 * sigmaAt(run.parameters.depth_sensor, 2.0) / 4.0);
  return text;
}

std::string rowOf(ComputeContext& compute, const NoiseRun& run) {
  const PipelineParameters& parameters = run.parameters;
  const std::unique_ptr<Recording> recording = recordingOf(run);
  std::unique_ptr<ReconstructionPipeline> pipeline;
  Trajectory trajectory;
  size_t frames = 0;
  for (; const std::optional<RgbdFrame> frame = recording->next(); ++frames) {
    if (!pipeline)
      pipeline = std::make_unique<ReconstructionPipeline>(compute, parameters, frame->intrinsics);
    const TrackingResult tracking = pipeline->processFrame(*frame).tracking;
    if (tracking.status != TrackingStatus::kLost) trajectory.push_back({frame->stamp_s, tracking.T_W_D});
  }
  const double ate_m = trajectory.size() < 3 ? 0.0 : compareTrajectories(trajectory, run.truth).ate_m.rmse;
  char row[300];
  std::snprintf(row, sizeof(row), "| %s | %.1f | %zu | %zu | %.2f | %s | %.1f |\n", run.name.c_str(),
                1e3 * pipeline->map().parameters().voxel_size_m, frames, frames - trajectory.size(),
                1e3 * ate_m, surfaceOf(compute, *pipeline, run).c_str(),
                percentile(pipeline->timers().samplesMs().at("frame"), 0.5));
  return row;
}

// The office without noise and with that of the default sensor, at 5 mm.
std::vector<NoiseRun> officeRuns(const TrackingBenchmark& options) {
  TrackingBenchmark office = options;
  office.inputs = {"icl_office_kt0"};
  const std::string folder = dataFolder(options.data) + "/icl_office_kt0";
  if (!std::filesystem::exists(folder)) {
    std::cout << "there is no " << folder << "; see --data" << std::endl;
    return {};
  }
  const TrackingInput input = trackingInputs(office).front();
  NoiseRun run{"icl_office_kt0 without noise", input.parameters, input.open, input.truth, false};
  run.parameters.texture_odometry.enabled = false;
  std::vector<NoiseRun> runs = {run};
  run.noise = true;
  for (run.seed = 1; run.seed <= 5; ++run.seed) {
    run.name = "icl_office_kt0, seed " + std::to_string(run.seed);
    runs.push_back(run);
  }
  return runs;
}

// The large room with the noise of each sensor that sees that far, in its own voxels and in those of 5 mm.
std::vector<NoiseRun> roomRuns(const TrackingBenchmark& options) {
  static const SimulatedScene scene = makeScene("large_room");
  SimulationOptions simulation;
  simulation.scene = "large_room";
  simulation.frames = kNoisyFrames;
  simulation.noise = false;
  const SimulatedRecording recording(simulation);
  NoiseRun run;
  run.open = [simulation] { return std::make_unique<SimulatedRecording>(simulation); };
  for (int i = 0; i < simulation.frames; ++i) run.truth.push_back(recording.poseOf(i));
  run.scene = &scene;
  std::vector<NoiseRun> runs;
  for (const char* sensor : {"kinect_v1", "kinect_v2", "azure_kinect", "realsense_d4xx"}) {
    run.name = std::string("large_room, ") + sensor;
    run.parameters = {};
    loadParameterFile(run.parameters.table(), options.cfg + "/" + sensor + ".yaml");
    run.parameters.preprocessing.readout_s = run.parameters.preprocessing.stamp_delay_s = 0.0f;  // simulated
    runs.push_back(run);
    if (run.parameters.map.voxel_size_m == kFarVoxel_m) continue;
    run.parameters.map.voxel_size_m = kFarVoxel_m;
    runs.push_back(run);
  }
  return runs;
}

}  // namespace

void runNoise(const TrackingBenchmark& options) {
  std::filesystem::create_directories(options.output);
  ComputeContext compute(options.device);
  std::string table =
      "| input | voxel, mm | frames | lost | ATE RMSE, mm | surface off by, mean, mm: tracked, "
      "at given poses (sigma at 2 m / 4) | a frame takes, ms |\n|---|---|---|---|---|---|---|\n";
  std::cout << table << std::flush;
  std::vector<NoiseRun> runs = officeRuns(options);
  for (NoiseRun& run : roomRuns(options)) runs.push_back(std::move(run));
  for (const NoiseRun& run : runs) {
    const std::string row = rowOf(compute, run);
    std::cout << row << std::flush;
    table += row;
  }
  writeText(options.output + "/noise.md", table);
}

}  // namespace depth_fusion
