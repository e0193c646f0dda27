#include "tools/evaluation/wall_experiment.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "depth_fusion/common/error.h"
#include "depth_fusion/pipeline/reconstruction_pipeline.h"
#include "depth_fusion/surface_mesh/surface_mesh.h"
#include "depth_fusion/surface_mesh/triangle_mesh.h"

namespace depth_fusion {
namespace {

constexpr CameraIntrinsics kCamera{128, 96, 250.0, 250.0, 63.5, 47.5};
constexpr double kBorder_m = 0.03;
constexpr double kOnEdge_vox = 1e-3;

PipelineParameters pipelineParameters(const WallExperiment& experiment, const TsdfFusionParameters& fusion) {
  PipelineParameters parameters;
  parameters.map.voxel_size_m = experiment.voxel_size_m;
  parameters.map.blocks_per_axis = 64;
  parameters.map.pool_mib = 16;
  parameters.depth_sensor.sigma_base_m = static_cast<float>(experiment.first_sigma_m);
  parameters.depth_sensor.sigma_growth_per_m = 1e-6f;
  parameters.depth_sensor.lateral_sigma_px = 0.0f;
  parameters.preprocessing.bilateral_sigma_px = 0.1f;  // leaves the noise to the filters
  parameters.texture_odometry.enabled = false;
  parameters.tsdf_fusion = fusion;
  parameters.tsdf_fusion.distance = "projective";
  return parameters;
}

RgbdFrame frameOf(const WallExperiment& experiment, int number) {
  const WallFrame wall = experiment.frame_at(number);
  RgbdFrame frame;
  frame.intrinsics = kCamera;
  frame.depth = cv::Mat(kCamera.height, kCamera.width, CV_32FC1);
  cv::RNG random(static_cast<uint64_t>(experiment.seed * experiment.frames + number) + 1);
  random.fill(frame.depth, cv::RNG::NORMAL, wall.z_m, wall.sigma_m);
  if (experiment.told_of_noise) {
    const double weight = std::min(1.0, std::pow(experiment.first_sigma_m / wall.sigma_m, 2));
    frame.weights = cv::Mat(frame.depth.size(), CV_32FC1, cv::Scalar(weight));
  }
  return frame;
}

// Finds the errors of the zero crossings nearest to the wall, by the column's place. Vertices on edges along
// z lie in a column.
std::map<std::pair<int, int>, double> columnErrors(const TriangleMesh& mesh, double z_m,
                                                   double voxel_size_m) {
  const double half_width_m = 0.5 * kCamera.width / kCamera.fx * z_m - kBorder_m;
  const double half_height_m = 0.5 * kCamera.height / kCamera.fy * z_m - kBorder_m;
  std::map<std::pair<int, int>, double> errors;
  for (const MeshVertex& vertex : mesh.vertices) {
    const Eigen::Vector3f& p = vertex.position_W;
    if (std::abs(p.x()) > half_width_m || std::abs(p.y()) > half_height_m) continue;
    const double i = p.x() / voxel_size_m, j = p.y() / voxel_size_m;
    if (std::abs(i - std::round(i)) > kOnEdge_vox || std::abs(j - std::round(j)) > kOnEdge_vox) continue;
    const double error_m = p.z() - z_m;
    const auto [column, is_new] =
        errors.try_emplace({static_cast<int>(std::round(i)), static_cast<int>(std::round(j))}, error_m);
    if (!is_new && std::abs(error_m) < std::abs(column->second)) column->second = error_m;
  }
  return errors;
}

WallError errorOf(const TriangleMesh& mesh, double z_m, double voxel_size_m) {
  WallError result;
  double squares = 0.0;
  for (const auto& [column, error_m] : columnErrors(mesh, z_m, voxel_size_m)) {
    result.mean_m += error_m;
    squares += error_m * error_m;
    ++result.columns;
  }
  check(result.columns > 0, "the wall has no mesh; is its noise above map/truncation_m?");
  result.mean_m /= static_cast<double>(result.columns);
  result.rms_m = std::sqrt(squares / static_cast<double>(result.columns));
  return result;
}

}  // namespace

std::vector<WallError> runWallExperiment(ComputeContext& compute, const WallExperiment& experiment,
                                         const TsdfFusionParameters& fusion) {
  ReconstructionPipeline pipeline(compute, pipelineParameters(experiment, fusion), kCamera);
  std::vector<WallError> errors;
  for (int i = 0; i < experiment.frames; ++i) {
    pipeline.processFrame(frameOf(experiment, i), Pose::Identity());
    if (i < experiment.first_measured_frame) continue;
    TriangleMesh mesh;
    exportSurfaceMesh(compute, pipeline.map(), mesh);
    errors.push_back(errorOf(mesh, experiment.frame_at(i).z_m, experiment.voxel_size_m));
  }
  return errors;
}

WallExperiment growingNoise() {
  const auto sigmaAt = [](double z_m) {
    const DepthSensorParameters sensor;
    return sensor.sigma_base_m + sensor.sigma_growth_per_m * std::pow(z_m - sensor.sigma_from_m, 2);
  };
  WallExperiment experiment;
  experiment.first_sigma_m = sigmaAt(1.0);
  experiment.frame_at = [sigmaAt, last = experiment.frames - 1](int frame) {
    return WallFrame{1.0, sigmaAt(1.0 + static_cast<double>(frame) / last)};
  };
  return experiment;
}

double rootMeanSquare(const std::vector<WallError>& errors, size_t first) {
  double squares = 0.0;
  for (size_t i = first; i < errors.size(); ++i) squares += errors[i].rms_m * errors[i].rms_m;
  return std::sqrt(squares / static_cast<double>(errors.size() - first));
}

TsdfFusionParameters filterOfGain(const std::string& rule, double gain, double sigma_m) {
  TsdfFusionParameters fusion;
  fusion.rule = rule;
  fusion.gain_at_1m = static_cast<float>(gain);
  fusion.max_weight = 250.0f;
  fusion.weight_at_1m = static_cast<float>(gain / (1.0 - gain) * fusion.max_weight);
  fusion.process_sigma_m = static_cast<float>(gain / std::sqrt(1.0 - gain) * sigma_m);
  return fusion;
}

}  // namespace depth_fusion
