// .oni files: OpenNI2 plays them in a thread of its own, as fast as the frames are read.
#include <OpenNI.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <opencv2/imgproc.hpp>
#include <thread>

#include "acquisition/field_of_view.h"
#include "acquisition/openni2/openni2_thread.h"
#include "acquisition/openni2/runtime.h"
#include "acquisition/openni2/stream.h"
#include "depth_fusion/acquisition/oni_recording.h"
#include "depth_fusion/common/error.h"
#include "recording/recording_intrinsics.h"

namespace depth_fusion {
namespace {

constexpr int kMaxWait_ms = 5000;
constexpr std::chrono::milliseconds kCallbackBegins{
    20};  // from the player's look whether a stream runs to its memory

// OpenNI2 keeps a stream's newest frame only; this holds the player back until the one before has been read.
class OneAtATime : public BufferAllocator {
 public:
  OneAtATime() : BufferAllocator(std::make_shared<FrameBuffers>()) {}

  void* allocateFrameBuffer(int size) override {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return !unread_ || closing_; });
    unread_ = true;
    ++in_use_;
    return BufferAllocator::allocateFrameBuffer(size);
  }

  void freeFrameBuffer(void* data) override {
    BufferAllocator::freeFrameBuffer(data);
    change([this] { --in_use_; });
  }

  void noteRead() {
    change([this] { unread_ = false; });
  }
  void close() {
    change([this] { closing_ = true; });
  }
  // Waits until OpenNI2 has no frame of the stream any more, but not for ever.
  void awaitUnused() {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait_for(lock, std::chrono::milliseconds(kMaxWait_ms), [this] { return in_use_ == 0; });
  }

 private:
  template <class Change>
  void change(const Change& make) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      make();
    }
    changed_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  bool unread_ = false;
  bool closing_ = false;
  int in_use_ = 0;
};

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
    depth_ = std::make_unique<Track>(device_, ImageStream::kDepth, path);
    if (device_.hasSensor(openni::SENSOR_COLOR))
      color_ = std::make_unique<Track>(device_, ImageStream::kColor, path);
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
    while (!firstDepthIsReady() && !ended_) readAhead();
    if (depth_->images.empty()) return std::nullopt;
    DeviceImage depth = std::move(depth_->images.front());
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
  // A stream and its images that were read ahead.
  struct Track {
    Track(openni::Device& device, ImageStream kind, const std::string& path)
        : pace(new OneAtATime),
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
      pace->awaitUnused();
    }

    OneAtATime* pace;  // the stream's
    OpenNi2Stream stream;
    size_t count;
    size_t read = 0;
    std::deque<DeviceImage> images;
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
    if (!color_ || color_->atEnd()) return true;
    return !color_->images.empty() &&
           color_->images.back().device_time_s >= depth_->images.front().device_time_s;
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
    track.images.push_back(track.stream.read());
    ++track.read;
    track.pace->noteRead();
  }

  // Empty if there is none.
  cv::Mat nearestColor(double stamp_s) {
    std::deque<DeviceImage>& images = color_->images;
    while (!images.empty() && images.front().device_time_s < stamp_s - max_pairing_gap_s_) images.pop_front();
    const auto gap_s = [&](const DeviceImage& image) { return std::abs(image.device_time_s - stamp_s); };
    const auto nearest = std::min_element(images.begin(), images.end(),
                                          [&](const auto& a, const auto& b) { return gap_s(a) < gap_s(b); });
    if (nearest == images.end() || gap_s(*nearest) > max_pairing_gap_s_) return {};
    return colorOf(*nearest);
  }

  const OpenNi2Runtime runtime_;
  const std::string path_;
  const double max_pairing_gap_s_;
  openni::Device device_;
  std::unique_ptr<Track> depth_, color_;
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
