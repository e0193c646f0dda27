#include "apps/benchmark/covariance.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <random>

#include "apps/benchmark/tracking_inputs.h"
#include "common/io/text_file.h"
#include "depth_fusion/pipeline/map_odometry.h"
#include "depth_fusion/recording/trajectory_file.h"
#include "tools/evaluation/consistency.h"

namespace depth_fusion {
namespace {

constexpr double kSimulatedFps = 10.0;
constexpr double kMaxTruthGap_s = 0.05;  // between poses of the truth

struct CovarianceInput {
  const char* name;
  const char* scene;
  const char* params;  // of the sensor, in --cfg
  double scale_sigma;  // each run's sensor measures too long by a factor drawn with it
};

// A sensor of each kind; the last one's depth is off, as drift/scale has it.
constexpr CovarianceInput kInputs[] = {{"room", "room", "", 0.0},
                                       {"large_room", "large_room", "", 0.0},
                                       {"object", "object", "precision_scanner.yaml", 0.0},
                                       {"room_scaled", "room", "", 0.01}};

// What one run says: a mean over its frames, or its last frame.
struct RunOutcome {
  double pose_nees = 0.0, velocity_nees = 0.0;  // of the last frame; of all frames
  double error_m = 0.0, sigma_m = 0.0;          // of the last frame's position
  int lost = 0;
};

// Follows the frames of a run beside the truth.
class RunJudge {
 public:
  RunJudge(std::string name, std::ofstream& csv) : name_(std::move(name)), csv_(csv) {}

  void add(double stamp_s, const TrackingResult& tracked, const Pose& T_truth_D) {
    if (tracked.status == TrackingStatus::kLost) {
      ++outcome_.lost;
      return;
    }
    if (frames_++ == 0) T_W_truth_ = tracked.T_W_D * T_truth_D.inverse();
    TrackingResult truth;
    truth.T_W_D = T_W_truth_ * T_truth_D;
    const Vector6d error = twistFromPose(tracked.T_W_D * truth.T_W_D.inverse());
    const Matrix6d covariance = tracked.covariance + tracked.drift;
    outcome_.pose_nees = nees(error, covariance);
    outcome_.error_m = (tracked.T_W_D.translation() - truth.T_W_D.translation()).norm();
    const Matrix6d about_camera = adjoint(Pose(Eigen::Translation3d(-tracked.T_W_D.translation())));
    outcome_.sigma_m =
        std::sqrt((about_camera * covariance * about_camera.transpose()).bottomRightCorner<3, 3>().trace());
    const auto state = odometry_.add(stamp_s, tracked, Pose::Identity());
    const auto true_state = true_odometry_.add(stamp_s, truth, Pose::Identity());
    if (state && true_state)
      velocity_nees_ += nees(state->velocity - true_state->velocity, state->velocity_covariance);
    outcome_.velocity_nees = velocity_nees_ / std::max(frames_ - 1, 1);
    write(stamp_s, tracked, truth.T_W_D);
  }
  const RunOutcome& outcome() const { return outcome_; }

 private:
  void write(double stamp_s, const TrackingResult& tracked, const Pose& T_W_truth) {
    csv_ << name_ << ',' << std::to_string(stamp_s);
    const auto put = [&](const auto& matrix) { csv_ << matrix.format(kRow); };
    put(tracked.T_W_D.matrix().topRows<3>());
    put(T_W_truth.matrix().topRows<3>());
    put(tracked.covariance);
    put(tracked.drift);
    csv_ << '\n';
  }

  inline static const Eigen::IOFormat kRow{10, Eigen::DontAlignCols, ",", ",", "", "", ","};
  const std::string name_;
  std::ofstream& csv_;
  int frames_ = 0;
  Pose T_W_truth_ = Pose::Identity();
  MapOdometry odometry_, true_odometry_;
  double velocity_nees_ = 0.0;
  RunOutcome outcome_;
};

class CovarianceBenchmark {
 public:
  explicit CovarianceBenchmark(const CovarianceOptions& options)
      : options_(options), compute_(options.device) {
    std::filesystem::create_directories(options.output);
    csv_.open(options.output + "/covariance.csv");
    const NeesBounds bounds = neesBounds(options.runs);
    char head[400];
    std::snprintf(
        head, sizeof(head),
        "| input | runs | lost frames | NEES of the last pose (%.2f to %.2f) | NEES of velocities | "
        "position, error rms [mm] | its sigma [mm] |\n|---|---|---|---|---|---|---|\n",
        bounds.lower, bounds.upper);
    say(head);
  }

  void run() {
    for (const CovarianceInput& input : kInputs) {
      if (!isChosen(input.name)) continue;
      std::vector<RunOutcome> outcomes;
      for (int seed = 1; seed <= options_.runs; ++seed) outcomes.push_back(simulate(input, seed));
      sayRow(input.name, outcomes);
    }
    TrackingBenchmark real;
    real.data = options_.data;
    real.cfg = options_.cfg;
    for (const TrackingInput& input : recordedInputs(real)) {
      if (isChosen(input.name)) sayRow(input.name, {follow(input)});
    }
    writeText(options_.output + "/covariance.md", table_);
  }

 private:
  bool isChosen(const std::string& name) const {
    const std::vector<std::string>& chosen = options_.inputs;
    return chosen.empty() || std::find(chosen.begin(), chosen.end(), name) != chosen.end();
  }

  RunOutcome simulate(const CovarianceInput& input, int seed) {
    SimulationOptions options;
    options.scene = input.scene;
    options.frames = options_.frames;
    options.fps = kSimulatedFps;
    options.seed = static_cast<unsigned>(seed);
    options.intrinsics = makeScene(input.scene).sensor.camera;
    while (options.intrinsics.width > options_.width) options.intrinsics = halved(options.intrinsics);
    PipelineParameters parameters;
    parameters.drift = driftOfNoise();
    if (*input.params != '\0') loadParameterFile(parameters.table(), options_.cfg + "/" + input.params);
    parameters.drift.scale = static_cast<float>(input.scale_sigma);
    std::mt19937 random(options.seed);
    const double factor = 1.0 + input.scale_sigma * std::normal_distribution<double>()(random);
    SimulatedRecording recording(options);
    ReconstructionPipeline pipeline(compute_, parameters, options.intrinsics);
    RunJudge judge(input.name + (',' + std::to_string(seed)), csv_);
    while (std::optional<RgbdFrame> frame = recording.next()) {
      frame->depth *= factor;
      judge.add(frame->stamp_s, pipeline.processFrame(*frame).tracking, *frame->T_W_D);
    }
    return judge.outcome();
  }

  RunOutcome follow(const TrackingInput& input) {
    const std::unique_ptr<Recording> recording = input.open();
    std::unique_ptr<ReconstructionPipeline> pipeline;
    RunJudge judge(input.name + ",0", csv_);
    while (std::optional<RgbdFrame> frame = recording->next()) {
      if (pipeline == nullptr)
        pipeline = std::make_unique<ReconstructionPipeline>(compute_, input.parameters, frame->intrinsics);
      const TrackingResult tracked = pipeline->processFrame(*frame).tracking;
      const std::optional<Pose> truth = poseAt(input.truth, frame->stamp_s, kMaxTruthGap_s);
      if (truth) judge.add(frame->stamp_s, tracked, *truth);
    }
    return judge.outcome();
  }

  void sayRow(const std::string& name, const std::vector<RunOutcome>& outcomes) {
    RunOutcome mean;
    const double runs = static_cast<double>(outcomes.size());
    for (const RunOutcome& outcome : outcomes) {
      mean.pose_nees += outcome.pose_nees / runs;
      mean.velocity_nees += outcome.velocity_nees / runs;
      mean.error_m += outcome.error_m * outcome.error_m / runs;
      mean.sigma_m += outcome.sigma_m * outcome.sigma_m / runs;
      mean.lost += outcome.lost;
    }
    char row[300];
    std::snprintf(row, sizeof(row), "| %s | %zu | %d | %.2f | %.2f | %.2f | %.2f |\n", name.c_str(),
                  outcomes.size(), mean.lost, mean.pose_nees, mean.velocity_nees,
                  1e3 * std::sqrt(mean.error_m), 1e3 * std::sqrt(mean.sigma_m));
    say(row);
  }
  void say(const std::string& line) {
    std::cout << line << std::flush;
    table_ += line;
  }

  const CovarianceOptions& options_;
  ComputeContext compute_;
  std::ofstream csv_;
  std::string table_;
};

}  // namespace

void addCovarianceBenchmark(CLI::App& app, CovarianceOptions& options) {
  CLI::App* command = app.add_subcommand(
      "covariance",
      "tracks simulated runs, each on a way and with noise of its own, and the real recordings; writes "
      "covariance.md: errors in units of their covariances (NEES), and covariance.csv: the poses, the true "
      "ones, and the covariances of frame and drift");
  command->add_option("-o,--output", options.output, "folder of the results")->capture_default_str();
  command->add_option("--input", options.inputs, "only these inputs");
  command->add_option("--runs", options.runs, "of each simulated input")->capture_default_str();
  command->add_option("-n,--frames", options.frames, "of a simulated run")->capture_default_str();
  command->add_option("--width", options.width, "of simulated images, at most")->capture_default_str();
  command->add_option("--data", options.data, "folder of the real recordings");
  command->add_option("--cfg", options.cfg, "folder of the sensors' parameter files")->capture_default_str();
  command->add_option("--device", options.device, "part of the name of the OpenCL device");
  command->callback([&options] { CovarianceBenchmark(options).run(); });
}

}  // namespace depth_fusion
