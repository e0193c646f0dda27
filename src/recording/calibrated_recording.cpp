#include "recording/calibrated_recording.h"

#include "depth_fusion/common/error.h"
#include "depth_fusion/frames/y_down.h"

namespace depth_fusion {
namespace {

class CalibratedRecording : public Recording {
 public:
  CalibratedRecording(std::unique_ptr<Recording> recording, const RecordingOptions& options)
      : recording_(std::move(recording)), options_(options) {
    checkDistortion(options.distortion);
    try {
      checkDistortion(options.color_distortion);
    } catch (const Error& error) {
      options_.color_problem = error.what();
    }
  }

  std::optional<RgbdFrame> next() override {
    std::optional<RgbdFrame> frame = recording_->next();
    if (!frame) return frame;
    if (options_.depth_unit_m && frame->depth.type() == CV_16UC1)
      frame->depth_unit_m = *options_.depth_unit_m;
    if (options_.intrinsics) {
      frame->distortion = options_.distortion;
      if (!frame->color_intrinsics) frame->color_distortion = options_.distortion;
    }
    if (options_.color_intrinsics) {
      frame->color_intrinsics = options_.color_intrinsics;
      frame->color_distortion = options_.color_distortion;
      frame->T_C_D = options_.T_C_D;
    }
    if (!options_.color_problem.empty()) {
      frame->color_problem = options_.color_problem;
      frame->color.release();
    }
    makeYDown(*frame);
    return frame;
  }

  size_t frameCount() const override { return recording_->frameCount(); }
  std::string description() const override { return recording_->description(); }

 private:
  std::unique_ptr<Recording> recording_;
  RecordingOptions options_;
};

}  // namespace

std::unique_ptr<Recording> calibrated(std::unique_ptr<Recording> recording, const RecordingOptions& options) {
  return std::make_unique<CalibratedRecording>(std::move(recording), options);
}

}  // namespace depth_fusion
