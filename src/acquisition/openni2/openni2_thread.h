// The one thread that calls OpenNI2.
#pragma once

#include <functional>
#include <future>

namespace depth_fusion {

// Queues a call for the thread; inOpenNi2Thread() uses it.
void postToOpenNi2Thread(const std::function<void()>& call);

// Calls the function in the thread; returns what it returns, and throws what it throws. OpenNI2 keeps the ids
// of all threads that have called it, and whenever another one does, asks the system for each by
// pthread_kill, which from glibc 2.34 on crashes if it has ended (test CallersMayEnd). So one thread does it
// all, for as long as the process lives; nobody may wait in it for long.
template <class Function>
auto inOpenNi2Thread(const Function& function) -> decltype(function()) {
  std::packaged_task<decltype(function())()> task(function);
  auto result = task.get_future();
  postToOpenNi2Thread([&task] { task(); });
  return result.get();
}

}  // namespace depth_fusion
