#include "ros/nodelets/stage_nodelet.h"

#include <nodelet/detail/callback_queue.h>

#include <algorithm>
#include <utility>

#include "depth_fusion/common/percentile.h"
#include "ros/parameters/parameter_server.h"

namespace depth_fusion {
namespace {

using diagnostic_msgs::DiagnosticStatus;

constexpr double kReportPeriod_s = 1.0;
constexpr int kSilentReports = 3;       // without a frame, before that is a problem
constexpr uint64_t kFewestTooSlow = 5;  // one frame of so many may be skipped without a warning

boost::shared_ptr<void> shared(ros::CallbackQueueInterface& queue) {
  return dynamic_cast<nodelet::detail::CallbackQueue&>(queue).shared_from_this();
}

uint64_t droppedFor(const FrameAccount& account, const std::string& reason) {
  const auto found = std::find(account.reasons.begin(), account.reasons.end(), reason);
  return found == account.reasons.end()
             ? 0
             : account.dropped[static_cast<size_t>(found - account.reasons.begin())];
}

}  // namespace

void StageNodelet::onInit() {
  try {
    start();
  } catch (const std::exception& error) {
    NODELET_FATAL_STREAM(getName() << ": " << error.what());
    kept_queues_ = {shared(getMTCallbackQueue()), shared(getSTCallbackQueue())};
    throw;
  }
}

void StageNodelet::loadParameters(const ParameterTable& own,
                                  const std::vector<std::pair<std::string, ParameterTable>>& stages,
                                  const std::string& foreign) {
  parameter_groups_ = {{"", getMTPrivateNodeHandle(), own}};
  for (const auto& [name, table] : stages) {
    parameter_groups_.push_back({name, ros::NodeHandle(getMTNodeHandle(), name), table});
  }
  default_parameters_ = makeConfig(parameter_groups_);
  for (const ParameterGroup& group : parameter_groups_)
    depth_fusion::loadParameters(group.handle, group.table, group.name.empty() ? foreign : "");
  applyParameters();
}

void StageNodelet::refuseFromOtherProcess(const std::string& sender, Carries what) {
  if (what == Carries::kFrames) counter_.drop("from another process");
  NODELET_ERROR_STREAM_THROTTLE(
      5.0, getName() << ": " << sender << " runs in another process; load it in the same nodelet manager");
}

void StageNodelet::startReporting() {
  ros::NodeHandle& handle = getMTPrivateNodeHandle();
  timings_publisher_ = handle.advertise<StageTimings>("stage_timings", 1);
  updater_ = std::make_unique<diagnostic_updater::Updater>(getMTNodeHandle(), handle, getName());
  updater_->setHardwareID("none");
  updater_->add("frames", this, &StageNodelet::diagnoseFrames);
  report_timer_ = callbacks_.createWallTimer(handle, ros::WallDuration(kReportPeriod_s),
                                             [this](const ros::WallTimerEvent&) { report(); });
  reconfigure_server_ = std::make_unique<ReconfigureServer>(
      parameter_groups_, default_parameters_,
      ReconfigureServer::Nodelet{getName(),
                                 [this](const ReconfigureServer::Action& action) { betweenFrames(action); },
                                 [this] { applyParameters(); }});
}

void StageNodelet::stopServing() {
  reconfigure_server_.reset();
  callbacks_.close();
}

void StageNodelet::recordTimings(const StageTimers& timers) {
  const std::lock_guard<std::mutex> lock(timers_mutex_);
  for (const auto& [stage, samples_ms] : timers.samplesMs()) {
    for (const double sample_ms : samples_ms) timers_.record(stage, sample_ms);
  }
}

void StageNodelet::report() {
  publishTimings();
  clock_problem_ = clock_watch_.check(getName());
  updater_->force_update();
}

void StageNodelet::publishTimings() {
  StageTimings timings;
  timings.header.stamp = ros::Time::now();
  {
    const std::lock_guard<std::mutex> lock(timers_mutex_);
    for (const auto& [stage, samples_ms] : timers_.samplesMs()) {
      timings.stages.push_back(stage);
      timings.samples.push_back(static_cast<uint32_t>(samples_ms.size()));
      timings.median_ms.push_back(static_cast<float>(percentile(samples_ms, 0.5)));
      timings.p95_ms.push_back(static_cast<float>(percentile(samples_ms, 0.95)));
    }
    timers_.clear();
  }
  last_timings_ = timings;
  timings_publisher_.publish(timings);
}

void StageNodelet::warnOfMissingFrames(const FrameAccount& account,
                                       diagnostic_updater::DiagnosticStatusWrapper& status) {
  const uint64_t received = account.received - last_account_.received;
  const uint64_t too_slow = droppedFor(account, kTooSlow) - droppedFor(last_account_, kTooSlow);
  silent_reports_ = received == 0 ? silent_reports_ + 1 : 0;
  if (silent_reports_ >= kSilentReports && !frame_source_.empty()) {
    status.mergeSummary(DiagnosticStatus::WARN, "no frames from " + frame_source_ + "; see what that says");
  } else if (too_slow * kFewestTooSlow > received) {
    status.mergeSummary(DiagnosticStatus::WARN,
                        "too slow: " + std::to_string(too_slow) + " of " + std::to_string(received) +
                            " frames skipped; start with a larger map/voxel_size_m or with "
                            "model_view/half_size, or let the sensor send fewer");
  }
}

void StageNodelet::diagnoseFrames(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const FrameAccount account = counter_.account();
  status.summary(DiagnosticStatus::OK, "running");
  diagnose(status);
  warnOfMissingFrames(account, status);
  if (!clock_problem_.empty()) status.summary(DiagnosticStatus::WARN, clock_problem_);
  status.add("frames a second",
             static_cast<double>(account.processed - last_account_.processed) / kReportPeriod_s);
  last_account_ = account;
  status.add("frames received", account.received);
  status.add("frames processed", account.processed);
  if (account.missed > 0) status.add("frames missed", account.missed);
  for (size_t i = 0; i < account.reasons.size(); ++i)
    status.add("dropped: " + account.reasons[i], account.dropped[i]);
  for (size_t i = 0; i < last_timings_.stages.size(); ++i)
    status.addf(last_timings_.stages[i] + " ms", "%.2f median, %.2f p95", last_timings_.median_ms[i],
                last_timings_.p95_ms[i]);
}

}  // namespace depth_fusion
