// A thread that works on items one after the other; the newest survive when it is too slow.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <future>
#include <mutex>
#include <optional>
#include <thread>

namespace depth_fusion {

template <class Item>
class Worker {
 public:
  // `work` is called in the thread; `drop` is called with the items that did not fit, in whatever thread.
  Worker(size_t capacity, std::function<void(const Item&)> work, std::function<void(const Item&)> drop)
      : capacity_(capacity), work_(std::move(work)), drop_(std::move(drop)), thread_([this] { run(); }) {}

  ~Worker() { stop(); }

  // Waits for the item at work and forgets the items that wait. It may be called again.
  void stop() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      stopping_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
  }

  void push(const Item& item) {
    std::deque<Item> dropped;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      for (; items_.size() >= capacity_; items_.pop_front()) dropped.push_back(items_.front());
    }
    for (const Item& old : dropped) drop_(old);  // before the new one can be at work
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      items_.push_back(item);
    }
    changed_.notify_all();
  }

  // Serves work that had to wait for something else: if meanwhile as many items wait as can, the item at work
  // is dropped, and the next one returned in its place.
  std::optional<Item> nextIfFull(const Item& at_work) {
    std::optional<Item> next;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (items_.size() < capacity_) return std::nullopt;
      next = take(items_);
    }
    drop_(at_work);
    return next;
  }

  // Runs the action in the thread, before the next item; returns when it is done. Throws what it throws.
  void between(const std::function<void()>& action) {
    std::packaged_task<void()> task(action);
    std::future<void> done = task.get_future();
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      actions_.push_back(std::move(task));
    }
    changed_.notify_all();
    done.get();
  }

  size_t waiting() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return items_.size();
  }

 private:
  void run() {
    std::unique_lock<std::mutex> lock(mutex_);
    while (true) {
      changed_.wait(lock, [this] { return stopping_ || !items_.empty() || !actions_.empty(); });
      if (stopping_) return;
      if (actions_.empty()) {
        const Item item = take(items_);
        lock.unlock();
        work_(item);
      } else {
        std::packaged_task<void()> action = take(actions_);
        lock.unlock();
        action();
      }
      lock.lock();
    }
  }

  template <class T>
  static T take(std::deque<T>& queue) {
    T first = std::move(queue.front());
    queue.pop_front();
    return first;
  }

  const size_t capacity_;
  const std::function<void(const Item&)> work_, drop_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Item> items_;
  std::deque<std::packaged_task<void()>> actions_;
  bool stopping_ = false;
  std::thread thread_;  // last: it uses the others
};

}  // namespace depth_fusion
