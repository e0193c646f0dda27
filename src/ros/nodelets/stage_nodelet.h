// What the nodelets have in common: parameters, the account of their frames, stage timings, diagnostics.
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
#include "ros/nodelets/frame_counter.h"
#include "ros/nodelets/reconfigure_server.h"

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

  // Fills the rows from the parameter server: the nodelet's own from its private namespace, those of the stages, which it may
  // share with other nodelets, from the namespaces beside. Throws Error for what is unknown or does not fit.
  void loadParameters(const ParameterTable& own,
                      const std::vector<std::pair<std::string, ParameterTable>>& stages = {});

  // The last thing of start(): from here on diagnostics and timings go out, and parameters may change.
  void startReporting();
  // The first thing of a destructor.
  void stopReporting();

  // Records what the scope takes as the stage's; thread-safe, unlike StageTimers.
  void recordTimings(const StageTimers& timers);

  FrameCounter counter_;

 private:
  void onInit() final;
  void report();
  void diagnoseFrames(diagnostic_updater::DiagnosticStatusWrapper& status);
  void publishTimings();

  std::vector<ParameterGroup> parameter_groups_;
  dynamic_reconfigure::Config default_parameters_;
  std::unique_ptr<ReconfigureServer> reconfigure_server_;

  std::mutex timers_mutex_;
  StageTimers timers_;        // since the last report
  StageTimings last_timings_;
  ros::Publisher timings_publisher_;
  std::unique_ptr<diagnostic_updater::Updater> updater_;
  ros::WallTimer report_timer_;
  uint64_t last_processed_ = 0;
};

}  // namespace depth_fusion
