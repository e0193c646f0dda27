#include "apps/reconstruct/run.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <iostream>

#include "apps/reconstruct/growing_view.h"
#include "apps/reconstruct/loop_results.h"
#include "apps/reconstruct/results.h"
#include "apps/reconstruct/run_log.h"
#include "apps/reconstruct/second_pass.h"
#include "common/io/text_file.h"
#include "depth_fusion/common/error.h"
#include "depth_fusion/common/percentile.h"
#include "depth_fusion/frames/y_down.h"
#include "depth_fusion/registration/registered_recording.h"
#include "ros/bags/open_recording.h"

namespace depth_fusion {
namespace {

constexpr double kMaxPoseGap_s = 0.1;

std::atomic<bool> interrupted{false};

class Run {
 public:
  explicit Run(const RunOptions& options);
  int execute();

 private:
  void openRecording();
  void fuseRecording();
  // Reads the next frame, past those that cannot be read; returns nothing at the end.
  std::optional<RgbdFrame> nextFrame();
  bool mayReadOn() const { return options_.max_frames == 0 || log_.counts().read < options_.max_frames; }
  void buildPipeline(const CameraIntrinsics& camera);
  // Goes on with the map of --continue.
  void loadMap();
  FrameResult fuse(const RgbdFrame& frame, const RgbdFrame* next);
  // Fuses the frames once more where loops have them, if that moves them far enough.
  void applyLoops();
  void showProgress(bool last);
  // Returns 0 before the first frame.
  double medianFrame_ms() const;

  const RunOptions& options_;
  RunLog log_;
  ComputeContext compute_;
  std::unique_ptr<Recording> recording_;
  Trajectory poses_;
  CameraIntrinsics camera_;
  std::unique_ptr<ReconstructionPipeline> pipeline_;
  std::unique_ptr<MapSaver> saver_;  // null: the map is saved nowhere
  std::optional<GrowingView> view_;
};

Run::Run(const RunOptions& options) : options_(options), log_(options), compute_(options.device) {
  std::cout << "device: " << compute_.selfTestReport() << std::endl;
  openRecording();
  std::cout << "input: " << recording_->description() << std::endl;
  std::string remark;
  if (!options.trajectory_file.empty()) poses_ = readPoses(options.trajectory_file, &remark);
  if (!remark.empty()) log_.warn(remark);
  std::error_code error;
  std::filesystem::create_directories(options.output, error);
  check(!error && access(options.output.c_str(), W_OK) == 0,
        "the output folder " + options.output + " cannot be written" +
            (error ? " (" + error.message() + ")" : "") + "; choose another with --output");
  if (options.view) view_.emplace(options);
}

void Run::openRecording() {
  recording_ = registered(openRecordings(options_.inputs, options_.recording), compute_,
                          options_.parameters.registration);
}

int Run::execute() {
  try {
    fuseRecording();
  } catch (const std::exception& error) {
    if (log_.counts().tracked == 0) throw;
    log_.complain(std::string(error.what()) + "; written is what was fused before");
  }
  check(pipeline_ != nullptr, log_.input() + ": no frame could be read");
  if (const std::string problem = pipeline_->robotProblem(); !problem.empty()) log_.warn(problem);
  log_.conclude();
  if (pipeline_->loops() != nullptr && !interrupted) applyLoops();
  writeResults(options_, compute_, *pipeline_, saver_.get(), log_);
  return log_.failed() ? 1 : 0;
}

void Run::fuseRecording() {
  std::optional<RgbdFrame> frame = nextFrame();
  if (frame) buildPipeline(frame->intrinsics);
  while (frame && !interrupted) {
    log_.begin(*frame);
    std::optional<RgbdFrame> next = mayReadOn() ? nextFrame() : std::nullopt;
    const FrameResult result = fuse(*frame, next ? &*next : nullptr);
    log_.note(*frame, result, mapBytes(pipeline_->map().parameters(), pipeline_->submaps().blockCount()));
    if (const auto depth = pipeline_->depth()) log_.noteNoise(options_.parameters.depth_sensor, *depth);
    if (view_) view_->update(compute_, *pipeline_, log_);
    showProgress(false);
    frame = std::move(next);
  }
  if (pipeline_) showProgress(true);
  if (interrupted) log_.complain("interrupted; the frames so far are written");
}

std::optional<RgbdFrame> Run::nextFrame() {
  while (true) {
    try {
      StageTimers none;
      const StageTimers::Scope timer(pipeline_ ? pipeline_->timers() : none, "recording/read");
      return recording_->next();
    } catch (const Error& error) {
      log_.noteUnreadable(error.what());
      check(log_.counts().unreadable < recording_->frameCount(),
            "no frame of " + log_.input() + " can be read");
    }
  }
}

void Run::buildPipeline(const CameraIntrinsics& camera) {
  std::cout << "building the kernels (seconds, the first time on a machine) ..." << std::flush;
  StageTimers timers;
  {
    const StageTimers::Scope timer(timers, "build");
    pipeline_ = std::make_unique<ReconstructionPipeline>(compute_, options_.parameters, camera);
    camera_ = camera;
  }
  std::printf(" %.1f s\n", timers.samplesMs().at("build").front() / 1000.0);
  std::fflush(stdout);
  if (!options_.map.empty()) {
    checkPlace(options_.map);
    saver_ = std::make_unique<MapSaver>(options_.map);
  }
  if (options_.stored != nullptr) loadMap();
  // In a map that was loaded there is what no recording can fuse again.
  if (!options_.single_pass && options_.trajectory_file.empty() && options_.stored == nullptr)
    pipeline_->closeLoops();
}

void Run::loadMap() {
  const LoadedMap loaded = pipeline_->load(*options_.stored);
  if (options_.map == options_.continued) saver_->adopt(pipeline_->submaps(), loaded);
  log_.searchInMap();
  std::cout << "map: " << pipeline_->submaps().blockCount() << " blocks and " << loaded.keyframes.size()
            << " keyframes of " << options_.stored->name() << std::endl;
}

FrameResult Run::fuse(const RgbdFrame& frame, const RgbdFrame* next) {
  if (options_.trajectory_file.empty()) return pipeline_->processFrame(frame, next);
  if (const std::optional<Pose> T_W_D = poseAt(poses_, frame.stamp_s, kMaxPoseGap_s))
    return pipeline_->processFrame(frame, frame.y_mirrored ? mirroredY(*T_W_D) : *T_W_D);
  FrameResult without_pose;
  without_pose.tracking.reason = "no pose near its stamp in " + options_.trajectory_file;
  return without_pose;
}

void Run::applyLoops() {
  const LoopResults loops = resultsOf(*pipeline_->loops(), log_.trajectory());
  const std::string problem = pipeline_->loops()->problem();
  if (!problem.empty()) log_.complain(problem);
  writeText(options_.output + "/loops.csv", loops.table);
  const bool moves = loops.moved_m > static_cast<double>(options_.parameters.loops.least_move_m);
  if (!moves && !loops.joins_parts) return;
  try {
    openRecording();
  } catch (const std::exception& error) {
    return log_.complain(std::string(error.what()) + "; the map is as it was tracked, without loops");
  }
  std::printf("%zu loops move poses by up to %.0f mm: the frames are fused once more\n", loops.closed,
              1000.0 * loops.moved_m);
  writeTrajectory(options_.output + "/trajectory_without_loops.txt", log_.trajectory());
  log_.correct(loops);
  const StageTimers timers = pipeline_->timers();
  const Keyframes keyframes = movedTo(log_.trajectory(), pipeline_->keyframes());
  pipeline_.reset();  // its memory is needed
  pipeline_ = std::make_unique<ReconstructionPipeline>(compute_, options_.parameters, camera_);
  try {
    fuseAgain(*recording_, loops.keyframes, *pipeline_, log_, interrupted);
  } catch (const std::exception& error) {
    log_.complain(std::string(error.what()) + "; the map has the frames before, which were fused once more");
  }
  pipeline_->timers() = timers;
  pipeline_->setKeyframes(keyframes);
}

void Run::showProgress(bool last) {
  const size_t all = recording_->frameCount();
  log_.showProgress(options_.max_frames == 0 ? all : std::min(all, options_.max_frames), medianFrame_ms(),
                    pipeline_->submaps().blockCount(), last);
}

double Run::medianFrame_ms() const {
  const auto& samples_ms = pipeline_->timers().samplesMs();
  const auto frame = samples_ms.find("frame");
  return frame == samples_ms.end() ? 0.0 : percentile(frame->second, 0.5);
}

}  // namespace

int reconstruct(const RunOptions& options) {
  std::signal(SIGINT, [](int) { interrupted = true; });
  std::signal(SIGTERM, [](int) { interrupted = true; });
  return Run(options).execute();
}

}  // namespace depth_fusion
