#include "tools/simulation/altered_recording.h"

#include <algorithm>
#include <random>

namespace depth_fusion {
namespace {

constexpr double kBlackFrameInterval_s = 1.0 / 30.0;

class EveryNth : public Recording {
 public:
  EveryNth(std::unique_ptr<Recording> recording, size_t n) : recording_(std::move(recording)), n_(n) {}

  std::optional<RgbdFrame> next() override {
    std::optional<RgbdFrame> frame = recording_->next();
    for (size_t i = 1; i < n_ && recording_->next(); ++i) continue;
    return frame;
  }
  size_t frameCount() const override { return (recording_->frameCount() + n_ - 1) / n_; }
  std::string description() const override {
    return recording_->description() + ", one frame of " + std::to_string(n_);
  }

 private:
  std::unique_ptr<Recording> recording_;
  size_t n_;
};

class Irregular : public Recording {
 public:
  Irregular(std::unique_ptr<Recording> recording, size_t max_gap, unsigned seed)
      : recording_(std::move(recording)), max_gap_(max_gap), random_(seed) {}

  std::optional<RgbdFrame> next() override {
    std::optional<RgbdFrame> frame = recording_->next();
    for (size_t skipped = random_() % max_gap_; skipped > 0 && recording_->next(); --skipped) continue;
    return frame;
  }
  size_t frameCount() const override { return 2 * recording_->frameCount() / (max_gap_ + 1); }
  std::string description() const override { return recording_->description() + ", irregular"; }

 private:
  std::unique_ptr<Recording> recording_;
  size_t max_gap_;
  std::mt19937 random_;
};

class LightsOff : public Recording {
 public:
  LightsOff(std::unique_ptr<Recording> recording, size_t first, size_t count)
      : recording_(std::move(recording)), first_(first), count_(count) {}

  std::optional<RgbdFrame> next() override {
    std::optional<RgbdFrame> frame = recording_->next();
    if (frame && next_ >= first_ && next_ < first_ + count_) {
      frame->color = cv::Mat::zeros(frame->color.size(), frame->color.type());
    }
    ++next_;
    return frame;
  }
  size_t frameCount() const override { return recording_->frameCount(); }
  std::string description() const override {
    return recording_->description() + ", " + std::to_string(count_) + " frames in the dark";
  }

 private:
  std::unique_ptr<Recording> recording_;
  size_t first_, count_;
  size_t next_ = 0;
};

class Noisy : public Recording {
 public:
  Noisy(std::unique_ptr<Recording> recording, const DepthSensorParameters& sensor, const DepthRange& range,
        unsigned seed)
      : recording_(std::move(recording)), sensor_(sensor), range_(range), random_(seed) {}

  std::optional<RgbdFrame> next() override {
    std::optional<RgbdFrame> frame = recording_->next();
    if (!frame) return frame;
    cv::Mat depth_m;
    frame->depth.convertTo(depth_m, CV_32F, frame->depth_unit_m);
    std::normal_distribution<float> noise;
    for (auto z = depth_m.begin<float>(); z != depth_m.end<float>(); ++z) {
      if (!(*z > 0.0f)) continue;
      const float beyond_m = *z - sensor_.sigma_from_m;
      *z += noise(random_) * (sensor_.sigma_base_m + sensor_.sigma_growth_per_m * beyond_m * beyond_m);
      if (*z < range_.min_m || *z > range_.max_m) *z = 0.0f;
    }
    frame->depth = depth_m;
    frame->depth_unit_m = 1.0;
    return frame;
  }
  size_t frameCount() const override { return recording_->frameCount(); }
  std::string description() const override { return recording_->description() + ", with noise"; }

 private:
  std::unique_ptr<Recording> recording_;
  DepthSensorParameters sensor_;
  DepthRange range_;
  std::mt19937 random_;
};

class Interrupted : public Recording {
 public:
  Interrupted(const OpenRecording& open, const Interruption& interruption)
      : recording_(open()), again_(open()), interruption_(interruption) {}

  std::optional<RgbdFrame> next() override {
    if (std::optional<RgbdFrame> frame = recording_->next()) {
      last_ = *frame;
      return frame;
    }
    if (black_ < interruption_.black_frames) return blackFrame();
    if (repeated_++ == interruption_.repeated_frames) return std::nullopt;
    std::optional<RgbdFrame> frame = again_->next();
    if (frame) frame->stamp_s += kRepeatedLater_s;
    return frame;
  }
  size_t frameCount() const override {
    const size_t once = recording_->frameCount();
    return once + interruption_.black_frames + std::min(once, interruption_.repeated_frames);
  }
  std::string description() const override {
    return recording_->description() + ", then " + std::to_string(interruption_.black_frames) +
           " black frames and its start";
  }

 private:
  RgbdFrame blackFrame() {
    RgbdFrame frame = last_;
    frame.stamp_s += static_cast<double>(++black_) * kBlackFrameInterval_s;
    frame.T_W_D.reset();
    for (cv::Mat* image : {&frame.depth, &frame.color}) {
      *image = cv::Mat(image->size(), image->type(), cv::Scalar::all(0));
    }
    return frame;
  }

  std::unique_ptr<Recording> recording_, again_;
  Interruption interruption_;
  RgbdFrame last_;
  size_t black_ = 0;
  size_t repeated_ = 0;
};

}  // namespace

std::unique_ptr<Recording> everyNth(std::unique_ptr<Recording> recording, size_t n) {
  return std::make_unique<EveryNth>(std::move(recording), n);
}

std::unique_ptr<Recording> irregular(std::unique_ptr<Recording> recording, size_t max_gap, unsigned seed) {
  return std::make_unique<Irregular>(std::move(recording), max_gap, seed);
}

std::unique_ptr<Recording> lightsOff(std::unique_ptr<Recording> recording, size_t first, size_t count) {
  return std::make_unique<LightsOff>(std::move(recording), first, count);
}

std::unique_ptr<Recording> withNoise(std::unique_ptr<Recording> recording,
                                     const DepthSensorParameters& sensor, const DepthRange& range,
                                     unsigned seed) {
  return std::make_unique<Noisy>(std::move(recording), sensor, range, seed);
}

std::unique_ptr<Recording> interrupted(const OpenRecording& open, const Interruption& interruption) {
  return std::make_unique<Interrupted>(open, interruption);
}

Trajectory repeated(const Trajectory& trajectory) {
  Trajectory result = trajectory;
  for (const StampedPose& pose : trajectory) result.push_back({pose.stamp_s + kRepeatedLater_s, pose.T_W_D});
  return result;
}

}  // namespace depth_fusion
