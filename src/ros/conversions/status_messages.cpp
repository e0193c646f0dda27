#include "ros/conversions/status_messages.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "ros/conversions/messages.h"

namespace depth_fusion {

using diagnostic_msgs::DiagnosticStatus;
namespace {

const char* stateName(uint8_t state) {
  switch (state) {
    case TrackerStatus::TRACKING:
      return "tracking";
    case TrackerStatus::DEGENERATE:
      return "degenerate";
    case TrackerStatus::PAUSED:
      return "paused";
    case TrackerStatus::PREDICTED:
      return "predicted by odometry";
    default:
      return "lost";
  }
}

bool isLost(const TrackerStatus& tracker) {
  return tracker.state == TrackerStatus::LOST || tracker.state == TrackerStatus::PREDICTED;
}

// To what the pose is good that goes on without depth.
std::string predictedText(const MotionPrior& bridged) {
  const Matrix6d to_sensor = adjoint(bridged.T_W_D.inverse());
  const Matrix6d covariance = to_sensor * *bridged.covariance * to_sensor.transpose();
  char text[160];
  std::snprintf(text, sizeof(text), "; the pose goes on by %s, to %.2f m and %.1f degrees (one sigma)",
                bridged.origin.c_str(), std::sqrt(covariance.diagonal().tail<3>().sum()),
                std::sqrt(covariance.diagonal().head<3>().sum()) * 180.0 / M_PI);
  return text;
}

}  // namespace

TrackerStatus makeTrackerStatus(const std_msgs::Header& header, const TrackingResult& result) {
  TrackerStatus status;
  status.header = header;
  status.state = static_cast<uint8_t>(result.status);
  status.reason = result.reason;
  if (result.bridged) {
    status.state = TrackerStatus::PREDICTED;
    status.reason += predictedText(*result.bridged);
  }
  status.guessed_directions = result.guessed_directions;
  status.map_doubt = result.map_doubt;
  status.inliers = result.inliers;
  status.inlier_fraction = result.inlier_fraction;
  status.rmse_m = result.rmse_m;
  status.smallest_eigenvalue = result.smallest_eigenvalue;
  status.prior = result.prior;
  status.dropped_prior = result.dropped_prior;
  status.prior_sigmas = result.prior_sigmas;
  for (const PriorDistance& prior : result.priors) {
    status.priors.push_back(prior.origin);
    status.priors_sigmas.push_back(prior.sigmas);
  }
  status.explained = result.explained;
  status.latency_s = secondsBetween(header.stamp, ros::Time::now());
  return status;
}

void setUsage(MapStatus& status, const BlockMap::Usage& usage) {
  status.blocks = usage.blocks;
  status.blocks_free = usage.capacity - usage.blocks;
  status.bytes = usage.bytes;
  status.pool_bytes = usage.pool_bytes;
}

void setUsage(MapStatus& status, const std::vector<SubmapDescription>& submaps, const StoreUsage& store) {
  status.submaps = static_cast<uint32_t>(submaps.size());
  uint64_t blocks = 0;
  for (const SubmapDescription& submap : submaps) blocks += submap.blocks;
  status.blocks_elsewhere = blocks - std::min<uint64_t>(blocks, status.blocks);
  status.memory_bytes = store.memory_bytes;
  status.disk_bytes = store.disk_bytes;
}

void diagnose(const TrackerStatus& tracker, const std::string& problem, const std::string& advice,
              diagnostic_updater::DiagnosticStatusWrapper& status) {
  if (!problem.empty()) {
    status.summary(DiagnosticStatus::WARN, problem);
  } else if (isLost(tracker) && !tracker.reason.empty()) {
    status.summary(DiagnosticStatus::ERROR, "lost: " + tracker.reason + advice);
  } else if (!tracker.reason.empty()) {
    status.summary(DiagnosticStatus::WARN, tracker.reason);
  }
  if (!tracker.map_doubt.empty()) status.mergeSummary(DiagnosticStatus::WARN, tracker.map_doubt);
  if (!tracker.robot_problem.empty()) status.mergeSummary(DiagnosticStatus::WARN, tracker.robot_problem);
  status.add("state", tracker.frames.received == 0 ? "no frame yet" : stateName(tracker.state));
  status.add("inliers", tracker.inliers);
  status.add("rmse_m", tracker.rmse_m);
  status.add("keyframes", tracker.keyframes);
}

void diagnose(const MapStatus& map, const std::string& problem,
              diagnostic_updater::DiagnosticStatusWrapper& status) {
  const double used =
      static_cast<double>(map.blocks) / std::max(1.0, static_cast<double>(map.blocks + map.blocks_free));
  if (!problem.empty()) {
    status.summary(DiagnosticStatus::WARN, problem);
  } else if (map.blocks_left_out > 0) {
    status.summary(DiagnosticStatus::ERROR, map.reason);
  } else if (!map.reason.empty()) {
    status.summary(DiagnosticStatus::WARN, map.reason);
  }
  status.add("blocks", map.blocks);
  status.add("blocks left out", map.blocks_left_out);
  status.addf("pool used", "%.1f %%", 100.0 * used);
  status.add("submaps", map.submaps);
  status.add("blocks elsewhere", map.blocks_elsewhere);
  status.addf("elsewhere in memory, MiB", "%.1f", static_cast<double>(map.memory_bytes) / (1 << 20));
  status.addf("elsewhere in the store, MiB", "%.1f", static_cast<double>(map.disk_bytes) / (1 << 20));
  status.addf("map MiB", "%.1f", static_cast<double>(map.bytes) / (1 << 20));
}

}  // namespace depth_fusion
