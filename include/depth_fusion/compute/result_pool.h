// Results in device memory that others may hold on to while the next one is made.
#pragma once

#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>
#include <vector>

namespace depth_fusion {

template <class Result>
class ResultPool {
 public:
  explicit ResultPool(std::function<std::shared_ptr<Result>()> make) : make_(std::move(make)) { next(); }

  // The one that next() gave last.
  const std::shared_ptr<Result>& current() const { return current_; }

  // One that nobody holds: the current one if possible, else another, made only if all are held.
  const std::shared_ptr<Result>& next() {
    current_.reset();
    const auto unused =
        std::find_if(results_.begin(), results_.end(), [](const auto& r) { return r.use_count() == 1; });
    std::atomic_thread_fence(std::memory_order_acquire);  // what its last holder did to it is over
    if (unused != results_.end()) return current_ = *unused;
    results_.push_back(make_());
    return current_ = results_.back();
  }

 private:
  std::function<std::shared_ptr<Result>()> make_;
  std::vector<std::shared_ptr<Result>> results_;
  std::shared_ptr<Result> current_;
};

}  // namespace depth_fusion
