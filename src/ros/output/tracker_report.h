// The tracker's state after each frame, as a message and in diagnostics.
#pragma once

#include <depth_fusion/TrackerStatus.h>
#include <diagnostic_updater/DiagnosticStatusWrapper.h>
#include <ros/publisher.h>

#include <mutex>
#include <string>

namespace depth_fusion {

// Thread-safe.
class TrackerReport {
 public:
  // `statuses` is the topic icp_tracking/status.
  explicit TrackerReport(const ros::Publisher& statuses) : statuses_(statuses) {}

  // `fits_nowhere` means that the frame is lost though it could be tracked; `device` is the OpenCL device's
  // name.
  void publish(const TrackerStatus& status, bool fits_nowhere, const std::string& device);
  // Sets level and summary, and adds values, by the status published last. `problem` hinders frames before
  // they get to the tracker; it is empty if nothing does.
  void diagnose(const std::string& problem, diagnostic_updater::DiagnosticStatusWrapper& diagnosis) const;

 private:
  const ros::Publisher statuses_;
  mutable std::mutex mutex_;  // of the three that follow
  TrackerStatus status_;
  bool fits_nowhere_ = false;
  std::string device_;
};

}  // namespace depth_fusion
