#include "apps/benchmark/tracking.h"

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "apps/benchmark/noise.h"
#include "apps/benchmark/starts.h"
#include "apps/benchmark/tracking_inputs.h"
#include "common/io/text_file.h"
#include "depth_fusion/common/error.h"
#include "depth_fusion/surface_mesh/mesh_picture.h"
#include "depth_fusion/surface_mesh/surface_mesh.h"
#include "tools/evaluation/trajectory_error.h"

namespace depth_fusion {
namespace {

struct Variant {
  std::string name;
  std::vector<std::pair<std::string, std::string>> parameters;  // changed from the input's
};

// A prior without weight is where ICP starts, and no more.
const std::vector<Variant> kAblation = {
    {"ICP", {{"texture_odometry/enabled", "false"}, {"icp_tracking/degeneracy_threshold", "0"}}},
    {"ICP + texture",
     {{"texture_odometry/shared_error", "1000"}, {"icp_tracking/degeneracy_threshold", "0"}}},
    {"ICP + texture + eigenvalues", {}}};

const std::vector<Variant> kGates = {
    {"all gates", {}},
    {"no distance gate", {{"icp_tracking/coarse_distance_m", "10"}, {"icp_tracking/fine_distance_m", "10"}}},
    {"no normal gate",
     {{"icp_tracking/coarse_normal_angle_rad", "1.5707"}, {"icp_tracking/fine_normal_angle_rad", "1.5707"}}},
    {"no robust loss", {{"icp_tracking/huber_sigmas", "1000"}}},
    {"no inlier gates", {{"icp_tracking/min_inlier_fraction", "0"}, {"icp_tracking/min_inliers", "6"}}},
    {"no rmse gate", {{"icp_tracking/max_rmse_m", "1"}}},
    {"no jump gate",
     {{"icp_tracking/max_translation_m", "100"}, {"icp_tracking/max_rotation_rad", "3.1416"}}},
    {"no eigenvalue gate", {{"icp_tracking/degeneracy_threshold", "0"}}},
    {"no relocalisation gate", {{"relocalisation/min_inlier_fraction", "0"}}},
    {"no keyframes", {{"relocalisation/max_keyframes", "0"}}}};

struct VariantOutcome {
  size_t frames = 0, lost = 0, degenerate = 0;
  size_t wrong = 0;  // tracked, but farther than kWrong_m from the truth
  TrajectoryError error;
  double path_m = 0.0;
  double drift_m = 0.0;  // the largest error by the first pose
  TriangleMesh mesh;
};

double pathLength(const std::vector<PosePair>& pairs) {
  double length_m = 0.0;
  for (size_t i = 1; i < pairs.size(); ++i) {
    length_m += (pairs[i].T_W_truth.translation() - pairs[i - 1].T_W_truth.translation()).norm();
  }
  return length_m;
}

void measureErrors(const Trajectory& trajectory, const Trajectory& truth, VariantOutcome& outcome) {
  if (trajectory.size() < 3) return;
  outcome.error = compareTrajectories(trajectory, truth);
  const std::vector<PosePair>& pairs = outcome.error.pairs;
  outcome.path_m = pathLength(pairs);
  const Pose T_truth_estimate = pairs[0].T_W_truth * pairs[0].T_W_estimate.inverse();
  for (const PosePair& pair : pairs) {
    const double error_m =
        ((T_truth_estimate * pair.T_W_estimate).translation() - pair.T_W_truth.translation()).norm();
    outcome.drift_m = std::max(outcome.drift_m, error_m);
    if ((pair.T_W_estimate.translation() - pair.T_W_truth.translation()).norm() > kWrong_m) ++outcome.wrong;
  }
}

VariantOutcome runVariant(ComputeContext& compute, const TrackingInput& input,
                          const std::vector<RgbdFrame>& frames, const Variant& variant, bool with_mesh) {
  PipelineParameters parameters = input.parameters;
  for (const auto& [name, value] : variant.parameters) setParameter(parameters.table(), name, value);
  parameters.map.color = with_mesh;
  ReconstructionPipeline pipeline(compute, parameters, frames.front().intrinsics);
  VariantOutcome outcome;
  Trajectory trajectory;
  for (const RgbdFrame& frame : frames) {
    const TrackingResult tracking = pipeline.processFrame(frame).tracking;
    ++outcome.frames;
    if (tracking.status == TrackingStatus::kLost) {
      ++outcome.lost;
      continue;
    }
    if (tracking.status == TrackingStatus::kDegenerate) ++outcome.degenerate;
    trajectory.push_back({frame.stamp_s, tracking.T_W_D});
  }
  measureErrors(trajectory, input.truth, outcome);
  if (with_mesh) exportSurfaceMesh(compute, pipeline.map(), outcome.mesh);
  return outcome;
}

std::string tableHead() {
  return "| input | variant | frames | lost | degenerate | ATE RMSE, mm | drift, mm (% of the path) | wrong "
         "|\n"
         "|---|---|---|---|---|---|---|---|\n";
}

std::string variantRow(const TrackingInput& input, const Variant& variant, const VariantOutcome& outcome) {
  char row[300];
  std::snprintf(row, sizeof(row), "| %s | %s | %zu | %zu | %zu | %.2f | %.2f (%.2f) | %zu |\n",
                input.name.c_str(), variant.name.c_str(), outcome.frames, outcome.lost, outcome.degenerate,
                1000.0 * outcome.error.ate_m.rmse, 1000.0 * outcome.drift_m,
                outcome.path_m > 0.0 ? 100.0 * outcome.drift_m / outcome.path_m : 0.0, outcome.wrong);
  return row;
}

// Draws the variants' meshes side by side, all seen from where the last one is seen best.
void drawMeshes(const std::string& path, const std::vector<Variant>& variants,
                const std::vector<VariantOutcome>& outcomes) {
  const CameraIntrinsics camera = pictureCamera(640, 480, CV_PI / 3.0);
  if (outcomes.back().mesh.vertices.empty()) return;
  const Pose T_W_C = viewOf(outcomes.back().mesh, camera, viewNames().front());
  std::vector<cv::Mat> pictures;
  for (size_t i = 0; i < variants.size(); ++i) {
    pictures.push_back(renderMesh(outcomes[i].mesh, camera, T_W_C));
    cv::putText(pictures[i], variants[i].name, {12, 28}, cv::FONT_HERSHEY_SIMPLEX, 0.8,
                cv::Scalar::all(230.0), 2, cv::LINE_AA);
  }
  cv::Mat row;
  cv::hconcat(pictures, row);
  check(cv::imwrite(path, row, {cv::IMWRITE_JPEG_QUALITY, 85}), "picture " + path + " cannot be written");
}

void runBenchmark(const TrackingBenchmark& options) {
  std::filesystem::create_directories(options.output);
  ComputeContext compute(options.device);
  const std::vector<Variant>& variants = options.gates ? kGates : kAblation;
  std::string table = tableHead();
  std::cout << table << std::flush;
  for (const TrackingInput& input : trackingInputs(options)) {
    const std::vector<RgbdFrame> frames = framesOf(input);
    std::vector<VariantOutcome> outcomes;
    for (const Variant& variant : variants) {
      outcomes.push_back(runVariant(compute, input, frames, variant, !options.gates));
      table += variantRow(input, variant, outcomes.back());
      std::cout << variantRow(input, variant, outcomes.back()) << std::flush;
    }
    if (!options.gates) drawMeshes(options.output + "/" + input.name + ".jpg", variants, outcomes);
  }
  writeText(options.output + (options.gates ? "/gates.md" : "/ablation.md"), table);
}

}  // namespace

void addTrackingBenchmark(CLI::App& app, TrackingBenchmark& options) {
  CLI::App* command = app.add_subcommand(
      "tracking",
      "ICP / ICP + texture / ICP + texture + eigenvalues on scenes and recordings: a table, and the meshes");
  command->add_option("--output", options.output, "folder for the table and the pictures")
      ->capture_default_str();
  command->add_option("--data", options.data,
                      "folder of the real recordings [$DEPTH_FUSION_DATA or ../shared/data]");
  command->add_option("--cfg", options.cfg, "folder of the sensors' parameter files")->capture_default_str();
  command->add_option("--device", options.device, "OpenCL device, as of reconstruct");
  command->add_option("--input", options.inputs, "only these inputs");
  command->add_flag("--gates", options.gates, "what each gate brings and costs: one left out in turn");
  command->add_option("--starts", options.starts,
                      "so many starts at random frames and frame rates, in place of the table");
  command->add_option("--seed", options.seed, "of the random starts")->capture_default_str();
  command->add_flag(
      "--strides", options.strides,
      "every second to sixth frame from each of the first ten and from frame 211 on, with texture and "
      "without, in place of random starts");
  command->add_flag(
      "--noise", options.noise,
      "a rendered office and a large room with the noise of sensors, without texture in the office, in "
      "place of the table");
  command->callback([&options] {
    if (options.noise) return runNoise(options);
    options.starts > 0 || options.strides ? runStarts(options) : runBenchmark(options);
  });
}

}  // namespace depth_fusion
