#include "store/process_apart.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <exception>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

constexpr unsigned kMost_s = 300;  // of a process, lest somebody waits for one that hangs

// It dies quietly, without the files and messages of a crash.
[[noreturn]] void workAndEnd(const std::function<void(int pipe)>& work, int pipe) {
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  signal(SIGALRM, SIG_DFL);
  signal(SIGPIPE, SIG_DFL);
  alarm(kMost_s);
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDERR_FILENO);
  try {
    work(pipe);
  } catch (const std::exception&) {
    _exit(1);
  }
  _exit(0);
}

int await(pid_t worker) {
  int status = 0;
  while (waitpid(worker, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

}  // namespace

bool runApart(const std::function<void(int pipe)>& work, const std::function<void(int pipe)>& read) {
  int ends[2];
  check(pipe2(ends, O_CLOEXEC) == 0, "there is no pipe to another process");
  const pid_t worker = fork();
  if (worker == 0) {
    close(ends[0]);
    workAndEnd(work, ends[1]);
  }
  close(ends[1]);
  if (worker < 0) close(ends[0]);
  check(worker > 0, "no process can be started");
  try {
    read(ends[0]);
  } catch (...) {
    close(ends[0]);
    await(worker);
    throw;
  }
  close(ends[0]);
  const int status = await(worker);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

bool readAll(int pipe, void* bytes, size_t count) {
  auto* next = static_cast<char*>(bytes);
  while (count > 0) {
    const ssize_t got = read(pipe, next, count);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    next += got;
    count -= static_cast<size_t>(got);
  }
  return true;
}

bool writeAll(int pipe, const void* bytes, size_t count) {
  const auto* next = static_cast<const char*>(bytes);
  while (count > 0) {
    const ssize_t gone = write(pipe, next, count);
    if (gone < 0 && errno == EINTR) continue;
    if (gone <= 0) return false;
    next += gone;
    count -= static_cast<size_t>(gone);
  }
  return true;
}

}  // namespace depth_fusion
