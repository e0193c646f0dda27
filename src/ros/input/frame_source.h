// Where acquisition has its frames from: a recording or a camera.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>

#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>

#include "depth_fusion/common/stage_timers.h"
#include "ros/input/frame_counter.h"

namespace depth_fusion {

// What a source has of its nodelet, which outlives it.
struct SourceHost {
  ros::NodeHandle handle;
  std::string name;  // begins every line of the log
  FrameCounter& counter;
  std::function<void(const StageTimers&)> record_timings;
};

class FrameSource {
 public:
  explicit FrameSource(const SourceHost& host) : host_(host) {}
  virtual ~FrameSource() = default;

  // Publishes frames until stop(), or until there are no more.
  virtual void run() = 0;
  // From any thread.
  void stop();
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);
  // The nodelet's parameters have changed.
  virtual void applyParameters() {}

 protected:
  // False if stopping.
  bool sleep(double seconds);
  // For the user, until the next one; nothing while all is well. Warnings and errors are logged, too, once
  // each.
  void setState(unsigned char level, const std::string& state);
  // Values for diagnostics; called with the mutex held.
  virtual void addValues(diagnostic_updater::DiagnosticStatusWrapper&) {}

  const SourceHost host_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool stopping_ = false;

 private:
  unsigned char level_ = diagnostic_msgs::DiagnosticStatus::OK;
  std::string state_;
};

}  // namespace depth_fusion
