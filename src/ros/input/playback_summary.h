// What tracking and map made of the frames of a recording that was played.
#pragma once

#include <depth_fusion/MapStatus.h>
#include <depth_fusion/TrackerStatus.h>

#include <mutex>
#include <string>
#include <vector>

namespace depth_fusion {

// Thread-safe.
class PlaybackSummary {
 public:
  void noteMap(const MapStatus& status);
  void noteTracking(const TrackerStatus& status);

  // One line for the user. `with_latency`: the stamps were those of now, so that the poses' latency means
  // something.
  std::string text(size_t frames_sent, bool with_latency) const;

 private:
  mutable std::mutex mutex_;
  size_t fused_ = 0, lost_ = 0;
  std::vector<double> latencies_ms_;  // from image to pose
};

}  // namespace depth_fusion
