#include "ros/input/playback_summary.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "depth_fusion/common/percentile.h"

namespace depth_fusion {
namespace {

constexpr size_t kMaxLatencies = 100000;

}  // namespace

void PlaybackSummary::noteMap(const MapStatus& status) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (status.fused) ++fused_;
}

void PlaybackSummary::noteTracking(const TrackerStatus& status) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (status.state >= TrackerStatus::LOST) {
    ++lost_;
    return;
  }
  if (latencies_ms_.size() == kMaxLatencies) latencies_ms_.clear();
  latencies_ms_.push_back(1e3 * status.latency_s);
}

std::string PlaybackSummary::text(size_t frames_sent, bool with_latency) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::ostringstream text;
  text << frames_sent << " frames sent, " << fused_ << " fused, " << lost_ << " lost, "
       << frames_sent - std::min(frames_sent, fused_ + lost_) << " dropped";
  if (with_latency) {
    text << "; pose " << std::lround(percentile(latencies_ms_, 0.5)) << " ms after the image (median), "
         << std::lround(percentile(latencies_ms_, 0.95)) << " ms (95 %)";
  }
  return text.str();
}

}  // namespace depth_fusion
