#include "ros/input/frame_source.h"

#include <algorithm>

namespace depth_fusion {

void FrameSource::stop() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
}

void FrameSource::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!state_.empty()) status.summary(level_, state_);
  addValues(status);
}

bool FrameSource::sleep(double seconds) {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait_for(lock, std::chrono::duration<double>(std::max(seconds, 0.0)),
                    [this] { return stopping_; });
  return !stopping_;
}

void FrameSource::setState(unsigned char level, const std::string& state) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (state == state_) return;
    level_ = level;
    state_ = state;
  }
  if (level == diagnostic_msgs::DiagnosticStatus::ERROR) ROS_ERROR_STREAM(host_.name << ": " << state);
  if (level == diagnostic_msgs::DiagnosticStatus::WARN) ROS_WARN_STREAM(host_.name << ": " << state);
}

}  // namespace depth_fusion
