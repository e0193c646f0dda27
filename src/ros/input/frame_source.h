// Where acquisition has its frames from: a recording or a camera.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>

#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>

#include "depth_fusion/common/stage_timers.h"
#include "ros/in_process/frame_counter.h"

namespace depth_fusion {

// What a source needs of its nodelet, which outlives it.
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
  // Ends run(). May be called from any thread.
  void stop();
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);
  // Is called when the nodelet's parameters have changed.
  virtual void applyParameters() {}

 protected:
  // Sleeps until stop() at most. Returns false when stopped.
  bool sleep(double seconds);
  // Says in diagnostics how the source is, until the next call; an empty text means that all is well.
  // Warnings and errors are logged, too, once each.
  void setState(unsigned char level, const std::string& state);
  // Adds values to diagnostics. It is called with the mutex held.
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
