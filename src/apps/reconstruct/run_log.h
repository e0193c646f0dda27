// What becomes of the frames of a run: the account for its report, and what is said of it on the console.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "apps/reconstruct/loop_results.h"
#include "apps/reconstruct/report.h"
#include "apps/reconstruct/run.h"
#include "depth_fusion/recording/trajectory_file.h"
#include "tools/report/run_record.h"

namespace depth_fusion {

class RunLog {
 public:
  explicit RunLog(const RunOptions& options);

  // The recording's files, for messages.
  const std::string& input() const { return input_; }
  const RunCounts& counts() const { return counts_; }
  // The poses of the tracked frames.
  const Trajectory& trajectory() const { return trajectory_; }
  // What the page tells of the frames; empty without --report.
  const RunRecord& record() const { return record_; }
  // Whether anything was complained of.
  bool failed() const { return failed_; }

  // The next calls are about another frame, which was read.
  void begin(const RgbdFrame& frame);
  // The sensor is searched for in a map that was loaded.
  void searchInMap() { is_searched_for_ = true; }
  // After it the map takes so much memory.
  void note(const RgbdFrame& frame, const FrameResult& result, size_t map_bytes);
  // Says once if the noise is not what the sensor model says.
  void noteNoise(const DepthSensorParameters& sensor, const DepthFrame& depth);
  // Says each reason once.
  void noteUnreadable(const std::string& why);
  // The tracked frames' poses are those that loops make of them.
  void correct(const LoopResults& loops);
  // Says what is wrong with the whole, after the last frame.
  void conclude();

  // Prints how far the run is of so many frames: now and then, or on a terminal always, in the same line.
  void showProgress(size_t all_frames, double frame_ms, size_t blocks, bool last) const;
  // The same of the second pass.
  void showSecondPass(size_t frames, bool last) const;
  // Prints what is no failure on standard error.
  void warn(const std::string& message) const;
  // The same of what is.
  void complain(const std::string& message);

 private:
  void noteLoss(const std::string& reason);
  // A map begins. Poses of one before it, which is gone, have no place in it.
  void noteBegin(const std::string& reason);
  void noteTracked(const TrackingResult& tracking);
  void noteFusion(const FusionResult& fusion);
  // Says once that the map may be wrong.
  void noteDoubt(const std::string& doubt);
  void noteMostLost();
  void noteManyUnreadable();
  // Prints an event of the frame on a line of its own.
  void say(const std::string& event) const;
  const RunOptions& options_;
  const std::string input_;
  RunCounts counts_;
  RunRecord record_;
  Trajectory trajectory_;
  std::string status_;      // of the last frame
  std::string part_doubt_;  // of the map, since a part began
  std::set<std::string> said_unreadable_;
  bool is_lost_ = false;          // the frame before
  bool is_searched_for_ = false;  // in a map that was loaded
  bool pool_was_full_ = false;
  bool window_was_left_ = false;
  bool color_was_bad_ = false;
  bool stamp_was_bad_ = false;
  bool noise_was_said_ = false;
  bool failed_ = false;
};

}  // namespace depth_fusion
