// Memory for a stream of a file, by which its player is held back.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>

#include "acquisition/openni2/stream.h"

namespace depth_fusion {

// Counts the images that a player has taken out of its file, of all streams.
using ImageCounter = std::atomic<int>;

// OpenNI2 keeps a stream's newest frame only; this holds the player back until the one before has been read.
// Thread-safe.
class OneAtATime : public BufferAllocator {
 public:
  // Keeps a reference.
  explicit OneAtATime(ImageCounter& counter)
      : BufferAllocator(std::make_shared<FrameBuffers>()), counter_(counter) {}

  void* allocateFrameBuffer(int size) override {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return !unread_ || closing_; });
    unread_ = true;
    ++in_use_;
    place_ = counter_++;
    return BufferAllocator::allocateFrameBuffer(size);
  }

  void freeFrameBuffer(void* data) override {
    BufferAllocator::freeFrameBuffer(data);
    change([this] { --in_use_; });
  }

  // The frame has been read. Returns its place in the file, among the images of all streams.
  int noteRead() {
    int place = 0;
    change([&] {
      unread_ = false;
      place = place_;
    });
    return place;
  }
  void close() {
    change([this] { closing_ = true; });
  }
  // Waits until OpenNI2 has no frame of the stream any more, but not for ever.
  void awaitUnused(std::chrono::milliseconds at_most) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait_for(lock, at_most, [this] { return in_use_ == 0; });
  }

 private:
  template <class Change>
  void change(const Change& make) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      make();
    }
    changed_.notify_all();
  }

  ImageCounter& counter_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool unread_ = false;
  bool closing_ = false;
  int in_use_ = 0;
  int place_ = 0;  // of the frame that came last
};

}  // namespace depth_fusion
