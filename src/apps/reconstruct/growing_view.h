// The scan while it grows, in the viewer's window.
#pragma once

#include <chrono>
#include <string>

#include "apps/reconstruct/run_log.h"

namespace depth_fusion {

// Writes mesh.ply and trajectory.txt of the run now and then, for the app `view`, which it starts as a
// process of its own and leaves running.
class GrowingView {
 public:
  // Throws Error if there is no viewer beside this app.
  explicit GrowingView(const RunOptions& options);

  // Writes them if enough time has passed: at most a tenth of the run's time goes into it. Throws Error if
  // they cannot be written.
  void update(ComputeContext& compute, ReconstructionPipeline& pipeline, const RunLog& log);

 private:
  using Clock = std::chrono::steady_clock;

  const RunOptions& options_;
  const std::string viewer_;  // the program
  bool is_started_ = false;
  Clock::time_point next_ = Clock::now();
};

}  // namespace depth_fusion
