// What a report remembers of a run, frame by frame.
#pragma once

#include <cstddef>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "depth_fusion/frames/rgbd_frame.h"
#include "depth_fusion/frames/tracking_result.h"

namespace depth_fusion {

struct RecordedFrame {
  double stamp_s = 0.0;
  TrackingStatus status = TrackingStatus::kLost;
  std::string reason;  // as TrackingResult has it
  bool is_tracked =
      true;  // false: the pose was given, or begins a map, so that nothing says how well it fits
  double explained = 0.0;  // how much of the frame the map explains, 0 to 1
  double map_bytes = 0.0;  // what the map takes after it
};

// A frame that went badly, to be looked at.
struct WorstFrame {
  size_t frame = 0;  // its index in RunRecord::frames()
  double badness = 0.0;
  cv::Mat picture;  // small, CV_8UC3 BGR: its colour, or its depth in colours
};

class RunRecord {
 public:
  // The frames before one that begins a map count as lost: their poses are of a map that is gone.
  void note(const RgbdFrame& frame, const TrackingResult& tracking, size_t map_bytes);

  const std::vector<RecordedFrame>& frames() const { return frames_; }
  // The frames that went worst, in the order of time, none near another.
  const std::vector<WorstFrame>& worst() const { return worst_; }
  // The recording's world was turned from y up to y down (see y_down.h).
  bool yMirrored() const { return y_mirrored_; }

 private:
  void keepIfBad(const RgbdFrame& frame, double badness);

  std::vector<RecordedFrame> frames_;
  std::vector<WorstFrame> worst_;
  bool y_mirrored_ = false;
};

// Frames in a row that were lost.
struct LostFrames {
  size_t first = 0;  // its index
  size_t count = 0;
};

std::vector<LostFrames> lossesOf(const std::vector<RecordedFrame>& frames);

size_t countOf(const std::vector<RecordedFrame>& frames, TrackingStatus status);

}  // namespace depth_fusion
