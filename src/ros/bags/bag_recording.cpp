// Bags as recordings, streamed: depth waits for the colour nearest in time no longer than that can take to
// arrive.
#include <cmath>
#include <deque>
#include <limits>

#include "common/nearest.h"
#include "recording/color_or_problem.h"
#include "ros/bags/bag_images.h"
#include "ros/bags/bag_sources.h"
#include "ros/bags/open_recording.h"

namespace depth_fusion {
namespace {

// How much later than the other an image of the same moment may stand in the bag.
constexpr double kMostLatency_s = 0.5;

class BagRecording : public Recording {
 public:
  BagRecording(const std::string& path, const RecordingOptions& options)
      : max_pairing_gap_s_(options.max_pairing_gap_s),
        most_wait_s_(kMostLatency_s + options.max_pairing_gap_s),
        bag_(openBagFile(path)),
        sources_(findSources(*bag_, options)) {
    view_.addQuery(*bag_, rosbag::TopicQuery(sources_.depth_topic));
    depth_count_ = view_.size();
    if (!sources_.color_topic.empty()) view_.addQuery(*bag_, rosbag::TopicQuery(sources_.color_topic));
    place_ = view_.begin();
  }

  std::optional<RgbdFrame> next() override {
    while (!firstDepthIsReady() && place_ != view_.end()) readAhead();
    if (depth_images_.empty()) return std::nullopt;
    const BagImage depth_image = depth_images_.front();
    depth_images_.pop_front();
    check(depth_image.stamp_s > last_stamp_s_,
          depth_image.name + ": an image is not later than the one before it; it is left out");
    last_stamp_s_ = depth_image.stamp_s;
    forgetColor(
        [&](const BagImage& color) { return color.stamp_s < depth_image.stamp_s - max_pairing_gap_s_; });
    return makeFrame(depth_image);
  }

  size_t frameCount() const override { return depth_count_; }

  std::string description() const override {
    const std::string color = sources_.color_topic.empty() ? "none" : sources_.color_topic;
    return "bag " + bag_->getFileName() + ": " + std::to_string(depth_count_) + " depth images of " +
           sources_.depth_topic + ", colour " + color + ", intrinsics " + describe(sources_.intrinsics) +
           sources_.remark;
  }

 private:
  bool firstDepthIsReady() const {
    if (depth_images_.empty()) return false;
    const BagImage& depth = depth_images_.front();
    const bool later_color_is_here = !color_images_.empty() && color_images_.back().stamp_s >= depth.stamp_s;
    return sources_.color_topic.empty() || later_color_is_here || newest_s_ > depth.received_s + most_wait_s_;
  }

  void readAhead() {
    const rosbag::MessageInstance place = *place_;
    ++place_;
    const BagImage image = readImage(place, *bag_);
    newest_s_ = image.received_s;
    const bool is_depth = place.getTopic() == sources_.depth_topic;
    (is_depth ? depth_images_ : color_images_).push_back(image);
    forgetColor([&](const BagImage& color) { return color.received_s < newest_s_ - 2.0 * most_wait_s_; });
  }

  template <class IsOld>
  void forgetColor(const IsOld& is_old) {
    while (!color_images_.empty() && is_old(color_images_.front())) color_images_.pop_front();
  }

  RgbdFrame makeFrame(const BagImage& depth_image) const {
    const DepthImage depth = toDepth(depth_image);
    RgbdFrame frame;
    frame.stamp_s = depth_image.stamp_s;
    frame.depth = depth.image;
    frame.depth_unit_m = depth.unit_m;
    frame.intrinsics = sources_.intrinsics.camera;
    frame.distortion = sources_.distortion;
    frame.color_intrinsics = sources_.color_intrinsics;
    frame.color_distortion = sources_.color_distortion;
    frame.T_C_D = sources_.T_C_D;
    checkDepthSize(frame.depth, frame.intrinsics, depth_image.name);
    const BagImage* color_image = nearest(color_images_, max_pairing_gap_s_, [&](const BagImage& color) {
      return std::abs(color.stamp_s - frame.stamp_s);
    });
    if (color_image == nullptr) return frame;
    frame.color_stamp_s = color_image->stamp_s;
    readColorOrProblem(frame, [&] { return toColor(*color_image); });
    return frame;
  }

  double max_pairing_gap_s_;
  double most_wait_s_;
  std::unique_ptr<rosbag::Bag> bag_;
  BagSources sources_;
  rosbag::View view_;
  rosbag::View::iterator place_;
  size_t depth_count_ = 0;
  std::deque<BagImage> depth_images_;
  std::deque<BagImage> color_images_;
  double newest_s_ = 0.0;
  double last_stamp_s_ = -std::numeric_limits<double>::infinity();
};

}  // namespace

std::unique_ptr<Recording> openBag(const std::string& path, const RecordingOptions& options) {
  return std::make_unique<BagRecording>(path, options);
}

}  // namespace depth_fusion
