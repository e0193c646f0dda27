#include "apps/reconstruct/growing_view.h"

#include <spawn.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "apps/reconstruct/results.h"
#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

constexpr auto kShortestPause = std::chrono::seconds(1);
constexpr int kPausesPerWriting = 9;

// In a process group of its own, so that Ctrl-C ends the run and the window stays.
void start(const std::string& viewer, const std::string& model) {
  std::string program = "view", shown = model, follow = "--follow";
  char* const arguments[] = {program.data(), shown.data(), follow.data(), nullptr};
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  pid_t process = 0;
  const int error = posix_spawn(&process, viewer.c_str(), nullptr, &attributes, arguments, environ);
  posix_spawnattr_destroy(&attributes);
  check(error == 0, "--view: " + viewer + " cannot be started");
}

}  // namespace

GrowingView::GrowingView(const RunOptions& options)
    : options_(options),
      viewer_(std::filesystem::read_symlink("/proc/self/exe").replace_filename("view").string()) {
  check(access(viewer_.c_str(), X_OK) == 0, "--view: there is no " + viewer_ + "; build the app view");
}

void GrowingView::update(ComputeContext& compute, ReconstructionPipeline& pipeline, const RunLog& log) {
  const Clock::time_point begin = Clock::now();
  if (begin < next_ || log.trajectory().empty()) return;
  writeTrajectory(options_.output + "/trajectory.txt", log.trajectory());
  writeMesh(options_, compute, pipeline);
  if (!std::exchange(is_started_, true)) start(viewer_, options_.output);
  const Clock::time_point end = Clock::now();
  next_ = end + std::max<Clock::duration>(kShortestPause, kPausesPerWriting * (end - begin));
}

}  // namespace depth_fusion
