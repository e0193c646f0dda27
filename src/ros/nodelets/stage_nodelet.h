// What the nodelets have in common: parameters, topics between them, the account of their frames, stage
// timings, diagnostics.
#pragma once

#include <depth_fusion/StageTimings.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <nodelet/nodelet.h>

#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "depth_fusion/common/error.h"
#include "depth_fusion/common/stage_timers.h"
#include "ros/callbacks/callback_gate.h"
#include "ros/in_process/frame_counter.h"
#include "ros/in_process/process_message.h"
#include "ros/input/clock_watch.h"
#include "ros/parameters/reconfigure_server.h"

namespace depth_fusion {

class StageNodelet : public nodelet::Nodelet {
 protected:
  // Loads parameters, subscribes and advertises; must return fast. Throws Error if it cannot work.
  virtual void start() = 0;
  // Takes over parameters that have changed. Throws Error if they do not fit together.
  virtual void applyParameters() {}
  // Runs the action when no frame is at work, and returns when it is done.
  virtual void betweenFrames(const std::function<void()>& action) { action(); }
  // Sets level and summary, and adds values. Called once a second.
  virtual void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) = 0;

  // Fills the rows from the parameter server: the nodelet's own from its private namespace, those of the
  // stages, which it may share with other nodelets, from the namespaces beside. What stands below `foreign`
  // in its private namespace is somebody else's. Throws Error for what is unknown or does not fit.
  void loadParameters(const ParameterTable& own,
                      const std::vector<std::pair<std::string, ParameterTable>>& stages = {},
                      const std::string& foreign = "");

  // Subscribes what the nodelet `sender` of the same process publishes, frames or something else. What comes
  // from another process has no payload, so it is not taken: an error says what to do, and frames are counted
  // as dropped.
  enum class Carries { kFrames, kOther };
  template <class Payload>
  ros::Subscriber subscribeInProcess(
      const std::string& topic, const std::string& sender, Carries what,
      std::function<void(const boost::shared_ptr<const ProcessMessage<Payload>>&)> take);

  // Is called at the end of start(): diagnostics and timings go out from here on, and parameters may change.
  void startReporting();
  // Is called at the beginning of the destructor: timers and services end.
  void stopServing();

  // Adds what the timers have to the report. Thread-safe.
  void recordTimings(const StageTimers& timers);

  FrameCounter counter_;
  CallbackGate callbacks_;  // makes every timer and service of the nodelet

 private:
  // Of a nodelet that failed at its start, the loader gives up the callback queues before the nodelet itself
  // goes, with all that roscpp still serves from them. They are kept here until then.
  std::vector<boost::shared_ptr<void>> kept_queues_;  // first: the last to go

  void onInit() final;
  void refuseFromOtherProcess(const std::string& sender, Carries what);
  void report();
  void diagnoseFrames(diagnostic_updater::DiagnosticStatusWrapper& status);
  // Warns if no frame came since the last report, or if many were skipped.
  void warnOfMissingFrames(const FrameAccount& account, diagnostic_updater::DiagnosticStatusWrapper& status);
  void publishTimings();

  std::vector<ParameterGroup> parameter_groups_;
  dynamic_reconfigure::Config default_parameters_;
  std::unique_ptr<ReconfigureServer> reconfigure_server_;

  std::mutex timers_mutex_;
  StageTimers timers_;  // since the last report
  StageTimings last_timings_;
  ros::Publisher timings_publisher_;
  std::unique_ptr<diagnostic_updater::Updater> updater_;
  ros::WallTimer report_timer_;
  std::string frame_source_;  // the nodelet that frames come from; empty: from topics
  FrameAccount last_account_;
  int silent_reports_ = 0;
  ClockWatch clock_watch_;
  std::string clock_problem_;  // as of the last report
};

template <class Payload>
ros::Subscriber StageNodelet::subscribeInProcess(
    const std::string& topic, const std::string& sender, Carries what,
    std::function<void(const boost::shared_ptr<const ProcessMessage<Payload>>&)> take) {
  if (what == Carries::kFrames) frame_source_ = sender;
  return getMTNodeHandle().subscribe<ProcessMessage<Payload>>(
      topic, kProcessQueue, [=](const boost::shared_ptr<const ProcessMessage<Payload>>& message) {
        if (what == Carries::kFrames) counter_.receive();
        if (message->payload == nullptr) return refuseFromOtherProcess(sender, what);
        take(message);
      });
}

}  // namespace depth_fusion
