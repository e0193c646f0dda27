#include "apps/reconstruct/run_log.h"

#include <unistd.h>

#include <cstdio>
#include <iostream>
#include <utility>

#include "depth_fusion/preprocessing/sensor_noise.h"
#include "ros/bags/open_recording.h"

namespace depth_fusion {
namespace {

constexpr size_t kProgressFrames = 50;  // between two lines of progress

bool isTerminal() { return isatty(STDOUT_FILENO) != 0; }

}  // namespace

RunLog::RunLog(const RunOptions& options) : options_(options), input_(namesOf(options.inputs)) {}

void RunLog::begin(const RgbdFrame& frame) {
  ++counts_.read;
  const std::string color_problem = presentColorProblem(frame);
  if (!color_problem.empty() && !std::exchange(color_was_bad_, true))
    warn(color_problem + "; only the frame's depth is used, and so with others like it");
  if (!frame.stamp_problem.empty() && !std::exchange(stamp_was_bad_, true))
    warn(frame.stamp_problem + ", and so with others like it");
}

void RunLog::note(const RgbdFrame& frame, const FrameResult& result, size_t map_bytes) {
  if (options_.report) record_.note(frame, result.tracking, map_bytes);
  if (result.tracking.status == TrackingStatus::kLost) return noteLoss(result.tracking.reason);
  noteTracked(result.tracking);
  if (result.color.fused) ++counts_.colored;
  trajectory_.push_back({frame.stamp_s, result.tracking.T_W_D});
  noteFusion(result.fusion);
}

void RunLog::noteTracked(const TrackingResult& tracking) {
  if (std::exchange(is_searched_for_, false)) say("found in the map");
  if (std::exchange(is_lost_, false))
    say("tracking again after " + std::to_string(counts_.losses.back().frames) + " lost frames");
  if (tracking.prior == "start") noteBegin(tracking.reason);
  if (tracking.prior == "part start") {
    say(tracking.reason);
    part_doubt_ = tracking.map_doubt;
  }
  ++counts_.tracked;
  const bool degenerate = tracking.status == TrackingStatus::kDegenerate;
  if (degenerate) ++counts_.degenerate;
  status_ = degenerate ? "degenerate: " + tracking.reason : "tracking";
  noteDoubt(tracking.map_doubt);
}

void RunLog::noteBegin(const std::string& reason) {
  if (trajectory_.empty()) return;
  say(reason + "; " + std::to_string(trajectory_.size()) + " of them count as lost");
  counts_.lost += trajectory_.size();
  counts_.tracked = counts_.degenerate = counts_.colored = 0;
  trajectory_.clear();
}

void RunLog::noteLoss(const std::string& reason) {
  ++counts_.lost;
  status_ = "lost: " + reason;
  if (!std::exchange(is_lost_, true)) {
    counts_.losses.push_back({counts_.read, 0, reason});
    say(status_);
  }
  ++counts_.losses.back().frames;
}

void RunLog::noteFusion(const FusionResult& fusion) {
  const std::string at_frame = " at frame " + std::to_string(counts_.read);
  if (fusion.blocks_allocated < fusion.blocks_requested && !std::exchange(pool_was_full_, true)) {
    complain("the voxel pool is full" + at_frame +
             ": new surface is left out from here on; raise map/pool_mib or --voxel-size");
  }
  if (fusion.points_outside > 0 && !std::exchange(window_was_left_, true)) {
    warn(std::to_string(fusion.points_outside) + " samples of the surface lie outside of the map's window" +
         at_frame + " and are left out; raise map/blocks_per_axis");
  }
}

void RunLog::noteNoise(const DepthSensorParameters& sensor, const DepthFrame& depth) {
  if (noise_was_said_) return;
  const std::string remark = noiseRemark(sensor, depth.levels[0].sensor);
  noise_was_said_ = !remark.empty();
  if (noise_was_said_) say(remark);
}

void RunLog::noteDoubt(const std::string& doubt) {
  if (doubt.empty() || !counts_.map_doubt.empty()) return;
  counts_.map_doubt = doubt;
  warn(doubt);
}

void RunLog::noteUnreadable(const std::string& why) {
  ++counts_.unreadable;
  if (said_unreadable_.insert(why).second) complain(why);
}

void RunLog::noteManyUnreadable() {
  if (counts_.unreadable > said_unreadable_.size())
    complain(std::to_string(counts_.unreadable) + " of " + std::to_string(counts_.read + counts_.unreadable) +
             " frames could not be read, for the reasons above");
}

void RunLog::correct(const LoopResults& loops) {
  trajectory_ = loops.corrected;
  counts_.loops = loops.closed;
  counts_.moved_by_loops_m = loops.moved_m;
  if (!loops.keyframes.isApart() && counts_.map_doubt == part_doubt_) counts_.map_doubt.clear();
}

void RunLog::conclude() {
  if (counts_.tracked == 0) complain("no frame of " + input_ + " was fused; the last one is " + status_);
  noteMostLost();
  noteManyUnreadable();
  if (options_.parameters.map.color && counts_.colored == 0)
    complain("--color: no frame of " + input_ + " has a colour image that can be used");
}

void RunLog::noteMostLost() {
  if (counts_.tracked == 0 || 2 * counts_.lost <= counts_.read) return;
  const Loss& first = counts_.losses.front();
  complain(std::to_string(counts_.lost) + " of " + std::to_string(counts_.read) +
           " frames were lost, the first of them frame " + std::to_string(first.first_frame) + " (" +
           first.reason +
           "); the map holds the others only. Are intrinsics and depth unit right? See docs/messages.md");
}

void RunLog::showProgress(size_t all_frames, double frame_ms, size_t blocks, bool last) const {
  if (!isTerminal() && last == (counts_.read % kProgressFrames == 0)) return;
  std::printf("%sframe %zu/%zu  %.1f ms (%.0f fps)  %zu blocks  %zu lost  %-30s%s", isTerminal() ? "\r" : "",
              counts_.read, all_frames, frame_ms, frame_ms > 0.0 ? 1000.0 / frame_ms : 0.0, blocks,
              counts_.lost, status_.c_str(), isTerminal() && !last ? "" : "\n");
  std::fflush(stdout);
}

void RunLog::showSecondPass(size_t frames, bool last) const {
  if (!isTerminal() && last == (frames % kProgressFrames == 0)) return;
  std::printf("%sframe %zu/%zu fused again%s", isTerminal() ? "\r" : "", frames, trajectory_.size(),
              isTerminal() && !last ? "" : "\n");
  std::fflush(stdout);
}

void RunLog::say(const std::string& event) const {
  std::cout << (isTerminal() ? "\r" : "") << "frame " << counts_.read << ": " << event
            << (isTerminal() ? "\033[K" : "") << std::endl;
}

void RunLog::warn(const std::string& message) const { std::cerr << "reconstruct: " << message << std::endl; }

void RunLog::complain(const std::string& message) {
  failed_ = true;
  warn(message);
}

}  // namespace depth_fusion
