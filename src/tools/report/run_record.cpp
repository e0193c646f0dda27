#include "tools/report/run_record.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace depth_fusion {
namespace {

constexpr size_t kWorstFrames = 8;
constexpr size_t kLeastGap_frames = 30;
constexpr int kPictureWidth_px = 320;
// Frames that the map explains so well are none that went badly.
constexpr double kGoodEnough = 0.8;
constexpr double kFarDepth_m = 5.0;

// 0 for a frame that went well.
double badnessOf(const RecordedFrame& frame) {
  if (frame.status == TrackingStatus::kLost) return 3.0;
  if (!frame.is_tracked) return 0.0;
  const double unexplained = frame.explained < kGoodEnough ? 1.0 - frame.explained : 0.0;
  return unexplained + (frame.status == TrackingStatus::kDegenerate ? 1.0 : 0.0);
}

cv::Mat depthInColors(const RgbdFrame& frame) {
  cv::Mat near, colors;
  const double scale = 255.0 * frame.depth_unit_m / kFarDepth_m;
  frame.depth.convertTo(near, CV_8UC1, -scale, 255.0);
  cv::applyColorMap(near, colors, cv::COLORMAP_TURBO);
  colors.setTo(cv::Scalar::all(0), (frame.depth > 0) == 0);
  return colors;
}

cv::Mat pictureOf(const RgbdFrame& frame) {
  cv::Mat picture = frame.color.empty() ? depthInColors(frame) : frame.color;
  const double scale = static_cast<double>(kPictureWidth_px) / picture.cols;
  cv::resize(picture, picture, {}, scale, scale, cv::INTER_AREA);
  if (picture.channels() == 1) cv::cvtColor(picture, picture, cv::COLOR_GRAY2BGR);
  return picture;
}

}  // namespace

void RunRecord::note(const RgbdFrame& frame, const TrackingResult& tracking, size_t map_bytes) {
  y_mirrored_ = frame.y_mirrored;
  if (tracking.prior == "start") {
    for (RecordedFrame& before : frames_) {
      if (before.status != TrackingStatus::kLost) before.reason = "its map was given up";
      before.status = TrackingStatus::kLost;
    }
  }
  const bool is_tracked = !tracking.prior.empty() && tracking.prior != "start";
  frames_.push_back({frame.stamp_s, tracking.status, tracking.reason, is_tracked, tracking.explained,
                     static_cast<double>(map_bytes)});
  keepIfBad(frame, badnessOf(frames_.back()));
}

void RunRecord::keepIfBad(const RgbdFrame& frame, double badness) {
  if (badness <= 0.0) return;
  const size_t index = frames_.size() - 1;
  const bool is_near = !worst_.empty() && index - worst_.back().frame < kLeastGap_frames;
  if (is_near) {
    if (worst_.back().badness < badness) worst_.back() = {index, badness, pictureOf(frame)};
    return;
  }
  if (worst_.size() == kWorstFrames) {
    const auto best =
        std::min_element(worst_.begin(), worst_.end(),
                         [](const WorstFrame& a, const WorstFrame& b) { return a.badness < b.badness; });
    if (best->badness >= badness) return;
    worst_.erase(best);
  }
  worst_.push_back({index, badness, pictureOf(frame)});
}

std::vector<LostFrames> lossesOf(const std::vector<RecordedFrame>& frames) {
  std::vector<LostFrames> losses;
  for (size_t i = 0; i < frames.size(); ++i) {
    if (frames[i].status != TrackingStatus::kLost) continue;
    if (losses.empty() || losses.back().first + losses.back().count != i) losses.push_back({i, 0});
    ++losses.back().count;
  }
  return losses;
}

size_t countOf(const std::vector<RecordedFrame>& frames, TrackingStatus status) {
  return static_cast<size_t>(std::count_if(
      frames.begin(), frames.end(), [&](const RecordedFrame& frame) { return frame.status == status; }));
}

}  // namespace depth_fusion
