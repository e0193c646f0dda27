#include "apps/reconstruct/run.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <iostream>

#include "apps/reconstruct/report.h"
#include "depth_fusion/common/error.h"
#include "depth_fusion/common/percentile.h"
#include "depth_fusion/frames/y_down.h"
#include "depth_fusion/preprocessing/sensor_noise.h"
#include "depth_fusion/recording/trajectory_file.h"
#include "depth_fusion/registration/registered_recording.h"
#include "depth_fusion/surface_mesh/ply.h"
#include "depth_fusion/submaps/world_mesh.h"
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
  void fuseRecording();
  // Reads the next frame, past those that cannot be read; returns nothing at the end.
  std::optional<RgbdFrame> nextFrame();
  void buildPipeline(const CameraIntrinsics& camera);
  void fuseFrame(const RgbdFrame& frame, const RgbdFrame* next);
  void noteResult(const RgbdFrame& frame, const FrameResult& result);
  void noteLoss(const std::string& reason);
  // Prints an event of the frame on a line of its own.
  void say(const std::string& event) const;
  // Says the first time that a frame's colour cannot be used, or its stamp.
  void noteProblems(const RgbdFrame& frame);
  // Says once if the noise is not what the sensor model says.
  void noteNoise();
  // Says once that the map may be wrong.
  void noteDoubt(const std::string& doubt);
  void noteMostLost();
  void showProgress(bool last);
  // Returns 0 before the first frame.
  double medianFrame_ms() const;
  // Goes on with the map of --continue.
  void loadMap();
  void saveMap();
  void writeResults();
  void writeMesh(const std::string& path);
  // Does one thing of many that should all be tried; a failure is said and remembered.
  void attempt(const std::function<void()>& action);
  void complain(const std::string& message);

  const RunOptions& options_;
  std::string input_;  // the files, for messages
  ComputeContext compute_;
  std::unique_ptr<Recording> recording_;
  Trajectory poses_;
  std::unique_ptr<ReconstructionPipeline> pipeline_;
  std::unique_ptr<MapSaver> saver_;  // null: the map is saved nowhere
  Trajectory trajectory_;
  RunCounts counts_;
  std::string status_;
  bool is_lost_ = false;          // the frame before
  bool is_searched_for_ = false;  // in a map that was loaded
  bool pool_was_full_ = false;
  bool color_was_bad_ = false;
  bool stamp_was_bad_ = false;
  bool window_was_left_ = false;
  bool noise_was_said_ = false;
  bool failed_ = false;
};

Run::Run(const RunOptions& options)
    : options_(options), input_(namesOf(options.inputs)), compute_(options.device) {
  std::cout << "device: " << compute_.selfTestReport() << std::endl;
  recording_ = registered(openRecordings(options.inputs, options.recording), compute_,
                          options.parameters.registration);
  std::cout << "input: " << recording_->description() << std::endl;
  if (!options.trajectory_file.empty()) poses_ = readPoses(options.trajectory_file);
  std::error_code error;
  std::filesystem::create_directories(options.output, error);
  check(!error && access(options.output.c_str(), W_OK) == 0,
        "the output folder " + options.output + " cannot be written" +
            (error ? " (" + error.message() + ")" : "") + "; choose another with --output");
}

int Run::execute() {
  try {
    fuseRecording();
  } catch (const std::exception& error) {
    if (counts_.tracked == 0) throw;
    complain(std::string(error.what()) + "; written is what was fused before");
  }
  check(pipeline_ != nullptr, input_ + ": no frame could be read");
  if (counts_.tracked == 0) complain("no frame of " + input_ + " was fused; the last one is " + status_);
  noteMostLost();
  if (options_.parameters.map.color && counts_.colored == 0)
    complain("--color: no frame of " + input_ + " has a colour image that can be used");
  writeResults();
  return failed_ ? 1 : 0;
}

void Run::fuseRecording() {
  std::optional<RgbdFrame> frame = nextFrame();
  if (frame) buildPipeline(frame->intrinsics);
  while (frame && !interrupted) {
    ++counts_.read;
    std::optional<RgbdFrame> next;
    if (options_.max_frames == 0 || counts_.read < options_.max_frames) next = nextFrame();
    noteProblems(*frame);
    fuseFrame(*frame, next ? &*next : nullptr);
    noteNoise();
    showProgress(false);
    frame = std::move(next);
  }
  if (pipeline_) showProgress(true);
  if (interrupted) complain("interrupted; the frames so far are written");
}

void Run::buildPipeline(const CameraIntrinsics& camera) {
  std::cout << "building the kernels (seconds, the first time on a machine) ..." << std::flush;
  StageTimers timers;
  {
    const StageTimers::Scope timer(timers, "build");
    pipeline_ = std::make_unique<ReconstructionPipeline>(compute_, options_.parameters, camera);
  }
  std::printf(" %.1f s\n", timers.samplesMs().at("build").front() / 1000.0);
  std::fflush(stdout);
  if (!options_.map.empty()) {
    checkPlace(options_.map);
    saver_ = std::make_unique<MapSaver>(options_.map);
  }
  if (options_.stored != nullptr) loadMap();
}

void Run::loadMap() {
  const LoadedMap loaded = pipeline_->load(*options_.stored);
  if (options_.map == options_.continued) saver_->adopt(pipeline_->submaps(), loaded);
  is_searched_for_ = true;
  std::cout << "map: " << pipeline_->submaps().blockCount() << " blocks and " << loaded.keyframes.size()
            << " keyframes of " << options_.stored->name() << std::endl;
}

void Run::saveMap() {
  const SaveReport saved = pipeline_->save(*saver_);
  std::cout << saved.place << ": " << saved.blocks << " blocks, " << saved.bytes << " bytes" << std::endl;
}

std::optional<RgbdFrame> Run::nextFrame() {
  while (true) {
    try {
      StageTimers none;
      const StageTimers::Scope timer(pipeline_ ? pipeline_->timers() : none, "recording/read");
      return recording_->next();
    } catch (const Error& error) {
      ++counts_.unreadable;
      complain(error.what());
      check(counts_.unreadable < recording_->frameCount(), "no frame of " + input_ + " can be read");
    }
  }
}

void Run::fuseFrame(const RgbdFrame& frame, const RgbdFrame* next) {
  if (options_.trajectory_file.empty()) {
    noteResult(frame, pipeline_->processFrame(frame, next));
    return;
  }
  const std::optional<Pose> T_W_D = poseAt(poses_, frame.stamp_s, kMaxPoseGap_s);
  FrameResult result;
  result.tracking.reason = "no pose near its stamp in " + options_.trajectory_file;
  if (!T_W_D) return noteResult(frame, result);
  noteResult(frame, pipeline_->processFrame(frame, frame.y_mirrored ? mirroredY(*T_W_D) : *T_W_D));
}

void Run::noteResult(const RgbdFrame& frame, const FrameResult& result) {
  const TrackingResult& tracking = result.tracking;
  if (tracking.status == TrackingStatus::kLost) {
    noteLoss(tracking.reason);
    return;
  }
  if (std::exchange(is_searched_for_, false)) say("found in the map");
  if (is_lost_) say("tracking again after " + std::to_string(counts_.losses.back().frames) + " lost frames");
  is_lost_ = false;
  ++counts_.tracked;
  const bool degenerate = tracking.status == TrackingStatus::kDegenerate;
  if (degenerate) ++counts_.degenerate;
  if (result.color.fused) ++counts_.colored;
  status_ = degenerate ? "degenerate: " + tracking.reason : "tracking";
  if (!degenerate && !tracking.reason.empty()) say(tracking.reason);
  noteDoubt(tracking.map_doubt);
  trajectory_.push_back({frame.stamp_s, tracking.T_W_D});
  if (result.fusion.blocks_allocated < result.fusion.blocks_requested && !pool_was_full_) {
    pool_was_full_ = true;
    complain("the voxel pool is full at frame " + std::to_string(counts_.read) +
             ": new surface is left out from here on; raise map/pool_mib or --voxel-size");
  }
  if (result.fusion.points_outside > 0 && !window_was_left_) {
    window_was_left_ = true;
    std::cerr << "reconstruct: " << result.fusion.points_outside
              << " samples of the surface lie outside of the map's "
              << "window at frame " << counts_.read << " and are left out; raise map/blocks_per_axis"
              << std::endl;
  }
}

void Run::noteLoss(const std::string& reason) {
  ++counts_.lost;
  status_ = "lost: " + reason;
  if (!is_lost_) {
    counts_.losses.push_back({counts_.read, 0, reason});
    say(status_);
  }
  ++counts_.losses.back().frames;
  is_lost_ = true;
}

void Run::noteProblems(const RgbdFrame& frame) {
  const std::string color_problem = presentColorProblem(frame);
  if (!color_problem.empty() && !color_was_bad_) {
    color_was_bad_ = true;
    std::cerr << "reconstruct: " << color_problem
              << "; only the frame's depth is used, and so with others like it" << std::endl;
  }
  if (!frame.stamp_problem.empty() && !stamp_was_bad_) {
    stamp_was_bad_ = true;
    std::cerr << "reconstruct: " << frame.stamp_problem << ", and so with others like it" << std::endl;
  }
}

void Run::noteNoise() {
  const std::shared_ptr<const DepthFrame> depth = pipeline_->depth();
  if (depth == nullptr || noise_was_said_) return;
  const std::string remark = noiseRemark(options_.parameters.depth_sensor, depth->levels[0].sensor);
  noise_was_said_ = !remark.empty();
  if (noise_was_said_) say(remark);
}

void Run::noteDoubt(const std::string& doubt) {
  if (doubt.empty() || !counts_.map_doubt.empty()) return;
  counts_.map_doubt = doubt;
  std::cerr << "reconstruct: " << doubt << std::endl;
}

void Run::noteMostLost() {
  if (counts_.tracked == 0 || 2 * counts_.lost <= counts_.read) return;
  const Loss& first = counts_.losses.front();
  complain(std::to_string(counts_.lost) + " of " + std::to_string(counts_.read) +
           " frames were lost, the first of them frame " + std::to_string(first.first_frame) + " (" +
           first.reason +
           "); the map holds the others only. Are intrinsics and depth unit right? See docs/messages.md");
}

void Run::say(const std::string& event) const {
  const bool terminal = isatty(STDOUT_FILENO) != 0;
  std::cout << (terminal ? "\r" : "") << "frame " << counts_.read << ": " << event
            << (terminal ? "\033[K" : "") << std::endl;
}

void Run::showProgress(bool last) {
  const bool terminal = isatty(STDOUT_FILENO) != 0;
  if (!terminal && last == (counts_.read % 50 == 0)) return;
  const double frame_ms = medianFrame_ms();
  const size_t all = recording_->frameCount();
  std::printf("%sframe %zu/%zu  %.1f ms (%.0f fps)  %zu blocks  %zu lost  %-30s%s", terminal ? "\r" : "",
              counts_.read, options_.max_frames == 0 ? all : std::min(all, options_.max_frames), frame_ms,
              frame_ms > 0.0 ? 1000.0 / frame_ms : 0.0, pipeline_->map().usage().blocks, counts_.lost,
              status_.c_str(), terminal && !last ? "" : "\n");
  std::fflush(stdout);
}

double Run::medianFrame_ms() const {
  const auto& samples_ms = pipeline_->timers().samplesMs();
  const auto frame = samples_ms.find("frame");
  return frame == samples_ms.end() ? 0.0 : percentile(frame->second, 0.5);
}

void Run::writeResults() {
  const std::string folder = options_.output + "/";
  const size_t tracking_peak_rss_bytes = peakRssBytes();
  attempt([&] { writeTrajectory(folder + "trajectory.txt", trajectory_); });
  if (saver_ != nullptr && counts_.tracked > 0) attempt([&] { saveMap(); });
  if (!options_.no_mesh) attempt([&] { writeMesh(folder + "mesh.ply"); });
  attempt([&] {
    writeReport(folder + "report.json", input_, compute_, *pipeline_, counts_, tracking_peak_rss_bytes);
  });
}

void Run::writeMesh(const std::string& path) {
  const StageTimers::Scope timer(pipeline_->timers(), "surface_mesh");
  PlyWriter writer(path);
  WorldSnapshot world(pipeline_->submaps());
  const MeshStatistics mesh =
      exportWorldMesh(compute_, world, writer, options_.parameters.surface_mesh, world.hasColor());
  std::cout << path << ": " << mesh.size.vertices << " vertices, " << mesh.size.triangles << " triangles"
            << std::endl;
}

void Run::attempt(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::exception& error) {
    complain(error.what());
  }
}

void Run::complain(const std::string& message) {
  failed_ = true;
  std::cerr << "reconstruct: " << message << std::endl;
}

}  // namespace

int reconstruct(const RunOptions& options) {
  std::signal(SIGINT, [](int) { interrupted = true; });
  std::signal(SIGTERM, [](int) { interrupted = true; });
  return Run(options).execute();
}

}  // namespace depth_fusion
