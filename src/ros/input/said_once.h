// What is wrong is said once, and not with every image that it is wrong with.
#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <string>

namespace depth_fusion {

// One thread uses it.
class SaidOnce {
 public:
  // Whether the text is one to say now: it is not empty, and not among those that were said of late.
  bool isNew(const std::string& text) {
    if (text.empty() || std::find(said_.begin(), said_.end(), text) != said_.end()) return false;
    said_.push_back(text);
    if (said_.size() > kKept) said_.pop_front();
    return true;
  }
  // What was said may be said again.
  void forget() { said_.clear(); }

 private:
  static constexpr size_t kKept = 20;

  std::deque<std::string> said_;
};

}  // namespace depth_fusion
