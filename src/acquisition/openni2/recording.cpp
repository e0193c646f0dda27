// .oni files: OpenNI2 plays them in a thread of its own, as fast as the frames are read.
#include <OpenNI.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <opencv2/imgproc.hpp>
#include <thread>

#include "acquisition/field_of_view.h"
#include "acquisition/openni2/one_at_a_time.h"
#include "acquisition/openni2/openni2_thread.h"
#include "acquisition/openni2/runtime.h"
#include "acquisition/openni2/stream.h"
#include "depth_fusion/acquisition/oni_recording.h"
#include "depth_fusion/common/error.h"
#include "recording/recording_intrinsics.h"

namespace depth_fusion {
namespace {

constexpr int kMaxWait_ms = 5000;
constexpr double kLongAgo_s = 1e9;
constexpr size_t kMostWaiting = 200;  // depth images, for colour that does not come
constexpr std::chrono::milliseconds kCallbackBegins{
    20};  // from the player's look whether a stream runs to its memory

cv::Mat toMat(DeviceImage& image, int type) {
  return {image.height, image.width, type, image.pixels.data(), image.step};
}

cv::Mat colorOf(DeviceImage& image) {
  if (image.encoding == "mono8") return toMat(image, CV_8UC1).clone();
  cv::Mat bgr;
  cv::cvtColor(toMat(image, CV_8UC3), bgr, cv::COLOR_RGB2BGR);
  return bgr;
}

class OniRecording : public Recording {
 public:
  OniRecording(const std::string& path, const RecordingOptions& options)
      : path_(path), max_pairing_gap_s_(options.max_pairing_gap_s) {
    check(device_.open(path.c_str()) == openni::STATUS_OK && device_.isFile(),
          path + ": OpenNI2 cannot read it: " + openNi2Error());
    openni::PlaybackControl& playback = *device_.getPlaybackControl();
    check(
        playback.setRepeatEnabled(false) == openni::STATUS_OK && playback.setSpeed(0.0f) == openni::STATUS_OK,
        path + ": OpenNI2 cannot play it frame by frame: " + openNi2Error());
    depth_ = std::make_unique<Track>(device_, ImageStream::kDepth, path, counter_);
    if (device_.hasSensor(openni::SENSOR_COLOR))
      color_ = std::make_unique<Track>(device_, ImageStream::kColor, path, counter_);
    const CameraIntrinsics own = (color_ ? *color_ : *depth_).camera();
    const cv::Size size = depth_->size();
    intrinsics_ = chooseIntrinsics(
        options.intrinsics, RecordingIntrinsics{scaled(own, size), "of its field of view"}, size, path);
    if (color_ && color_->size() != size) color_intrinsics_ = own;
    depth_->stream.start();
    if (color_) color_->stream.start();
  }

  // OpenNI2's player may be at work on a frame, or held back; its stream must not go before it is done.
  ~OniRecording() override {
    for (Track* track : {depth_.get(), color_.get()}) {
      if (track != nullptr) track->stop();
    }
  }

  std::optional<RgbdFrame> next() override {
    if (!color_lead_s_) alignColor();
    while (!firstDepthIsReady() && !ended_) readAhead();
    if (depth_->images.empty()) return std::nullopt;
    DeviceImage depth = std::move(depth_->images.front().image);
    depth_->images.pop_front();
    check(depth.device_time_s > last_stamp_s_, path_ + ": a depth image of " +
                                                   std::to_string(depth.device_time_s) +
                                                   " s is not later than the one before it; it is left out");
    last_stamp_s_ = depth.device_time_s;
    RgbdFrame frame;
    frame.stamp_s = depth.device_time_s;
    frame.depth = toMat(depth, CV_16UC1).clone();
    frame.depth_unit_m = depth.depth_unit_m;
    frame.intrinsics = intrinsics_.camera;
    frame.color_intrinsics = color_intrinsics_;
    if (color_) frame.color = nearestColor(frame.stamp_s);
    return frame;
  }

  size_t frameCount() const override { return depth_->count; }

  std::string description() const override {
    return "OpenNI2 file " + path_ + ": " + std::to_string(depth_->count) + " depth images, " +
           std::to_string(color_ ? color_->count : 0) + " colour images, intrinsics " + describe(intrinsics_);
  }

 private:
  struct ReadImage {
    DeviceImage image;
    int place;  // in the file
  };
  // A stream and its images that were read ahead.
  struct Track {
    Track(openni::Device& device, ImageStream kind, const std::string& path, ImageCounter& counter)
        : pace(new OneAtATime(counter)),
          stream(device, kind, std::nullopt, path, std::unique_ptr<BufferAllocator>(pace)),
          count(static_cast<size_t>(
              std::max(0, device.getPlaybackControl()->getNumberOfFrames(stream.video())))) {}

    cv::Size size() const {
      const openni::VideoMode mode = stream.video().getVideoMode();
      return {mode.getResolutionX(), mode.getResolutionY()};
    }
    CameraIntrinsics camera() const {
      return cameraFromFieldOfView(size().width, size().height, stream.video().getHorizontalFieldOfView());
    }
    bool atEnd() const { return read == count; }
    void stop() {
      pace->close();
      stream.video().stop();
      std::this_thread::sleep_for(kCallbackBegins);
      stream.video().stop();  // forgets a frame that has come meanwhile
      pace->awaitUnused(std::chrono::milliseconds(kMaxWait_ms));
    }

    OneAtATime* pace;  // the stream's
    OpenNi2Stream stream;
    size_t count;
    size_t read = 0;
    std::deque<ReadImage> images;
  };

  // Gives the camera of the same view in another size.
  static CameraIntrinsics scaled(const CameraIntrinsics& camera, cv::Size size) {
    const double factor = static_cast<double>(size.width) / camera.width;
    return {size.width,
            size.height,
            factor * camera.fx,
            factor * camera.fy,
            0.5 * (size.width - 1),
            0.5 * (size.height - 1)};
  }

  bool firstDepthIsReady() const {
    if (depth_->images.empty()) return false;
    if (!color_ || color_->atEnd() || depth_->images.size() > kMostWaiting) return true;
    return !color_->images.empty() &&
           color_->images.back().image.device_time_s >= depth_->images.front().image.device_time_s;
  }

  void readAhead() {
    openni::VideoStream* videos[] = {&depth_->stream.video(), color_ ? &color_->stream.video() : nullptr};
    int ready = 0;
    ended_ = depth_->atEnd() && (!color_ || color_->atEnd());
    if (ended_) return;
    if (openni::OpenNI::waitForAnyStream(videos, color_ ? 2 : 1, &ready, kMaxWait_ms) != openni::STATUS_OK) {
      ended_ = true;
      throw Error(path_ + ": the file breaks off after " + std::to_string(depth_->read) + " of " +
                  std::to_string(depth_->count) + " depth images");
    }
    Track& track = ready == 0 ? *depth_ : *color_;
    DeviceImage image = track.stream.read();
    if (&track == color_.get()) image.device_time_s += color_lead_s_.value_or(0.0);
    ++track.read;
    track.images.push_back({std::move(image), track.pace->noteRead()});
  }

  // In a file every stream counts its time from its own first image. Where they did not begin together, as
  // when an image was lost or a stream was started later, the file's order tells: colour's first image is of
  // a time between those of the depth images before and after it.
  void alignColor() {
    const auto is_known = [this] {
      return !color_ || color_->atEnd() ||
             (!color_->images.empty() && !depth_->images.empty() &&
              depth_->images.back().place > color_->images.front().place);
    };
    while (!is_known() && !ended_ && depth_->images.size() <= kMostWaiting) readAhead();
    if (!is_known() && !ended_) return;
    color_lead_s_ = 0.0;
    if (!color_ || color_->images.empty()) return;
    double earliest_s = -kLongAgo_s, latest_s = kLongAgo_s;
    for (auto depth = depth_->images.rbegin(); depth != depth_->images.rend(); ++depth) {
      const bool is_before = depth->place < color_->images.front().place;
      if (is_before) earliest_s = std::max(earliest_s, depth->image.device_time_s);
      if (!is_before) latest_s = depth->image.device_time_s;
    }
    const double first_s = color_->images.front().image.device_time_s;
    color_lead_s_ = std::clamp(0.0, earliest_s - first_s, std::max(earliest_s, latest_s) - first_s);
    for (ReadImage& color : color_->images) color.image.device_time_s += *color_lead_s_;
  }

  // Empty if there is none.
  cv::Mat nearestColor(double stamp_s) {
    std::deque<ReadImage>& images = color_->images;
    while (!images.empty() && images.front().image.device_time_s < stamp_s - max_pairing_gap_s_)
      images.pop_front();
    const auto gap_s = [&](const ReadImage& read) { return std::abs(read.image.device_time_s - stamp_s); };
    const auto nearest = std::min_element(images.begin(), images.end(),
                                          [&](const auto& a, const auto& b) { return gap_s(a) < gap_s(b); });
    if (nearest == images.end() || gap_s(*nearest) > max_pairing_gap_s_) return {};
    return colorOf(nearest->image);
  }

  const OpenNi2Runtime runtime_;
  const std::string path_;
  const double max_pairing_gap_s_;
  openni::Device device_;
  ImageCounter counter_{0};
  std::unique_ptr<Track> depth_, color_;
  std::optional<double> color_lead_s_;  // what is added to colour's times; none before it is known
  RecordingIntrinsics intrinsics_;
  std::optional<CameraIntrinsics> color_intrinsics_;
  double last_stamp_s_ = -1.0;
  bool ended_ = false;
};

// An .oni file for callers in any thread.
class RecordingInOneThread : public Recording {
 public:
  RecordingInOneThread(const std::string& path, const RecordingOptions& options)
      : recording_(inOpenNi2Thread([&] { return std::make_unique<OniRecording>(path, options); })) {}
  ~RecordingInOneThread() override {
    inOpenNi2Thread([this] { recording_.reset(); });
  }

  std::optional<RgbdFrame> next() override {
    return inOpenNi2Thread([this] { return recording_->next(); });
  }
  size_t frameCount() const override { return recording_->frameCount(); }
  std::string description() const override { return recording_->description(); }

 private:
  std::unique_ptr<OniRecording> recording_;
};

}  // namespace

std::unique_ptr<Recording> openOni(const std::string& path, const RecordingOptions& options) {
  return std::make_unique<RecordingInOneThread>(path, options);
}

}  // namespace depth_fusion
