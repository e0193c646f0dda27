#include "depth_fusion/acquisition/frame_buffers.h"

namespace depth_fusion {
namespace {

constexpr size_t kMaxIdle = 16;

}  // namespace

uint8_t* FrameBuffers::allocate(size_t size) {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<uint8_t> bytes;
  if (!idle_.empty()) {
    bytes = std::move(idle_.back());
    idle_.pop_back();
  }
  bytes.resize(size);
  uint8_t* data = bytes.data();
  with_driver_.insert(data);
  unread_[data] = std::move(bytes);
  return data;
}

void FrameBuffers::release(const uint8_t* data) {
  const std::lock_guard<std::mutex> lock(mutex_);
  with_driver_.erase(data);
  const auto found = unread_.find(data);
  if (found == unread_.end()) return;
  keepIdle(std::move(found->second));
  unread_.erase(found);
}

std::optional<std::vector<uint8_t>> FrameBuffers::take(const uint8_t* data) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto found = unread_.find(data);
  if (found == unread_.end()) return std::nullopt;
  std::vector<uint8_t> bytes = std::move(found->second);
  unread_.erase(found);
  return bytes;
}

void FrameBuffers::recycle(std::vector<uint8_t> bytes) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const uint8_t* data = bytes.data();
  if (with_driver_.count(data) > 0) {
    unread_[data] = std::move(bytes);
  } else {
    keepIdle(std::move(bytes));
  }
}

void FrameBuffers::keepIdle(std::vector<uint8_t> bytes) {
  if (idle_.size() < kMaxIdle) idle_.push_back(std::move(bytes));
}

}  // namespace depth_fusion
