// What became of the frames that reached a nodelet.
#pragma once

#include <depth_fusion/FrameAccount.h>

#include <cstdint>
#include <map>
#include <mutex>
#include <string>

namespace depth_fusion {

// Why a frame is dropped that newer ones have overtaken.
constexpr char kTooSlow[] = "too slow";

class FrameCounter {
 public:
  void receive() { count(received_); }
  void process() { count(processed_); }
  // Counts frames that were sent and were lost on their way.
  void miss(uint32_t frames) { count(missed_, frames); }
  void drop(const std::string& reason) {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++dropped_[reason];
  }

  FrameAccount account() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    FrameAccount account;
    account.received = received_;
    account.processed = processed_;
    account.missed = missed_;
    for (const auto& [reason, frames] : dropped_) {
      account.reasons.push_back(reason);
      account.dropped.push_back(frames);
    }
    return account;
  }

 private:
  void count(uint64_t& number, uint64_t frames = 1) {
    const std::lock_guard<std::mutex> lock(mutex_);
    number += frames;
  }

  mutable std::mutex mutex_;
  uint64_t received_ = 0;
  uint64_t processed_ = 0;
  uint64_t missed_ = 0;
  std::map<std::string, uint64_t> dropped_;
};

}  // namespace depth_fusion
