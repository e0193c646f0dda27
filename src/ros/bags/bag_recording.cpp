// Bags as recordings, streamed: depth waits for the colour nearest in time no longer than that can take to
// arrive.
#include <cmath>
#include <deque>
#include <limits>

#include "common/io/text_file.h"
#include "common/nearest.h"
#include "recording/color_or_problem.h"
#include "recording/unpaired_color.h"
#include "ros/bags/bag_clock.h"
#include "ros/bags/bag_images.h"
#include "ros/bags/bag_robot.h"
#include "ros/bags/bag_sources.h"
#include "ros/bags/open_recording.h"

namespace depth_fusion {
namespace {

// How much later than the other an image of the same moment may stand in the bag.
constexpr double kMostLatency_s = 0.5;
constexpr size_t kMostWaiting = 100;  // images, where the times of receipt tell nothing

class BagRecording : public Recording {
 public:
  BagRecording(const std::vector<std::string>& paths, const RecordingOptions& options)
      : max_pairing_gap_s_(options.max_pairing_gap_s),
        most_wait_s_(kMostLatency_s + options.max_pairing_gap_s),
        bags_(paths),
        sources_(findSources(bags_, options)),
        robot_(bags_, sources_.depth_frame),
        clock_(sources_.stamp_lead_s) {
    bags_.addTo(view_, {sources_.depth_topic});
    depth_count_ = view_.size();
    if (!sources_.color_topic.empty()) bags_.addTo(view_, {sources_.color_topic});
    place_ = view_.begin();
  }

  std::optional<RgbdFrame> next() override {
    while (!firstDepthIsReady() && place_ != view_.end()) readAhead();
    if (depth_images_.empty()) return std::nullopt;
    const BagImage depth_image = depth_images_.front();
    depth_images_.pop_front();
    RgbdFrame frame = depthFrame(depth_image);
    addColor(depth_image, frame);
    if (frame.stamp_problem.empty())
      forgetColor(
          [&](const BagImage& color) { return color.stamp_s < depth_image.stamp_s - max_pairing_gap_s_; });
    return frame;
  }

  size_t frameCount() const override { return depth_count_; }

  std::string description() const override {
    const std::string color = sources_.color_topic.empty() ? "none" : sources_.color_topic;
    return "bag " + bags_.name() + ": " + std::to_string(depth_count_) + " depth images of " +
           sources_.depth_topic + ", colour " + color + ", intrinsics " + describe(sources_.intrinsics) +
           (robot_.description().empty() ? "" : ", " + robot_.description()) + sources_.remark;
  }

 private:
  bool firstDepthIsReady() const {
    if (depth_images_.empty()) return false;
    const BagImage& depth = depth_images_.front();
    const bool later_color_is_here = !color_images_.empty() && color_images_.back().stamp_s >= depth.stamp_s;
    return sources_.color_topic.empty() || later_color_is_here ||
           newest_s_ > depth.received_s + most_wait_s_ || depth_images_.size() > kMostWaiting;
  }

  void readAhead() {
    const rosbag::MessageInstance place = *place_;
    ++place_;
    newest_s_ = place.getTime().toSec();
    if (place.getTopic() == sources_.depth_topic) {
      depth_images_.push_back(readImage(place, bags_));
    } else {
      try {
        color_images_.push_back(readImage(place, bags_));
      } catch (const Error& error) {
        color_problem_ = error.what();
      }
    }
    forgetColor([&](const BagImage& color) {
      return color.received_s < newest_s_ - 2.0 * most_wait_s_ || color_images_.size() > kMostWaiting;
    });
  }

  template <class IsOld>
  void forgetColor(const IsOld& is_old) {
    while (!color_images_.empty() && is_old(color_images_.front())) color_images_.pop_front();
  }

  RgbdFrame depthFrame(const BagImage& depth_image) {
    RgbdFrame frame;
    const std::optional<double> time_s = clock_.timeOf(depth_image.stamp_s, depth_image.received_s);
    check(time_s.has_value(),
          depth_image.name + ": an image is not later than the one before it; it is left out");
    frame.stamp_s = *time_s;
    if (*time_s != depth_image.stamp_s)
      frame.stamp_problem = depth_image.name + ": the stamp " + stampText(depth_image.stamp_s) +
                            " does not go on from the one before it; the time of receipt counts";
    const DepthImage depth = toDepth(depth_image);
    frame.depth = depth.image;
    frame.depth_unit_m =
        depth.image.type() == CV_16UC1 ? sources_.depth_unit_m.value_or(depth.unit_m) : depth.unit_m;
    frame.intrinsics = sources_.intrinsics.camera;
    frame.distortion = sources_.distortion;
    frame.color_intrinsics = sources_.color_intrinsics;
    frame.color_distortion = sources_.color_distortion;
    frame.T_C_D = sources_.T_C_D;
    checkDepthSize(frame.depth, frame.intrinsics, depth_image.name);
    if (frame.stamp_problem.empty()) frame.readings = robot_.until(frame.stamp_s);
    return frame;
  }

  // Depth and colour have one clock: stamps, not times, say what belongs together, also where it jumps.
  void addColor(const BagImage& depth_image, RgbdFrame& frame) {
    if (sources_.color_topic.empty() && depth_image.message.cloud != nullptr) {
      frame.color = toColor(depth_image);
      return;
    }
    const BagImage* color_image = nearest(color_images_, max_pairing_gap_s_, [&](const BagImage& color) {
      return std::abs(color.stamp_s - depth_image.stamp_s);
    });
    if (color_image == nullptr) {
      std::swap(frame.color_problem, color_problem_);
      const std::string unpaired = unpaired_.noteUnpaired(nearestColor_s(depth_image), max_pairing_gap_s_);
      if (frame.color_problem.empty()) frame.color_problem = unpaired;
      return;
    }
    unpaired_.notePaired();
    frame.color_stamp_s = color_image->stamp_s + (frame.stamp_s - depth_image.stamp_s);
    readColorOrProblem(frame, [&] { return toColor(*color_image); });
  }

  // By how much the nearest colour is later, of what is here.
  std::optional<double> nearestColor_s(const BagImage& depth_image) const {
    const auto later_s = [&](const BagImage& color) { return color.stamp_s - depth_image.stamp_s; };
    const BagImage* color = nearest(color_images_, std::numeric_limits<double>::max(),
                                    [&](const BagImage& candidate) { return std::abs(later_s(candidate)); });
    return color == nullptr ? std::nullopt : std::optional<double>(later_s(*color));
  }

  double max_pairing_gap_s_;
  double most_wait_s_;
  BagFiles bags_;
  BagSources sources_;
  BagRobot robot_;
  BagClock clock_;
  rosbag::View view_;
  rosbag::View::iterator place_;
  size_t depth_count_ = 0;
  std::deque<BagImage> depth_images_;
  std::deque<BagImage> color_images_;
  UnpairedColor unpaired_;
  std::string color_problem_;  // of a message that could not be read, until it is said
  double newest_s_ = 0.0;
};

}  // namespace

std::unique_ptr<Recording> openBag(const std::string& path, const RecordingOptions& options) {
  return openBags({path}, options);
}

std::unique_ptr<Recording> openBags(const std::vector<std::string>& paths, const RecordingOptions& options) {
  return std::make_unique<BagRecording>(paths, options);
}

}  // namespace depth_fusion
