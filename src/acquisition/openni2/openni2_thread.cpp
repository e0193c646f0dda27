#include "acquisition/openni2/openni2_thread.h"

#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

namespace depth_fusion {
namespace {

class Caller {
 public:
  Caller() {
    std::thread([this] { work(); }).detach();
  }

  void post(const std::function<void()>& call) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      calls_.push_back(call);
    }
    changed_.notify_all();
  }

 private:
  [[noreturn]] void work() {
    std::unique_lock<std::mutex> lock(mutex_);
    while (true) {
      changed_.wait(lock, [this] { return !calls_.empty(); });
      const std::function<void()> call = std::move(calls_.front());
      calls_.pop_front();
      lock.unlock();
      call();
      lock.lock();
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> calls_;
};

}  // namespace

void postToOpenNi2Thread(const std::function<void()>& call) {
  static Caller& caller = *new Caller;  // never destroyed, as its thread never ends
  caller.post(call);
}

}  // namespace depth_fusion
