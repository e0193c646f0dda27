#include "recording/rectified_recording.h"

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

class RectifiedRecording : public Recording {
 public:
  RectifiedRecording(std::unique_ptr<Recording> recording, const std::vector<double>& distortion)
      : recording_(std::move(recording)), distortion_(distortion) {
    const size_t count = distortion_.size();
    check(count == 4 || count == 5 || count == 8,
          "lens distortion has 4, 5 or 8 coefficients (k1 k2 p1 p2 k3 k4 k5 k6), not " + std::to_string(count));
  }

  std::optional<RgbdFrame> next() override {
    std::optional<RgbdFrame> frame = recording_->next();
    if (!frame) return frame;
    if (sources_.empty()) mapPixels(frame->intrinsics);
    // Depth is not interpolated, for between two surfaces there is none.
    frame->depth = remapped(frame->depth, nearest_, cv::noArray(), cv::INTER_NEAREST);
    const bool registered = !frame->color_intrinsics && frame->color.size() == frame->depth.size();
    if (registered) frame->color = remapped(frame->color, sources_, source_fractions_, cv::INTER_LINEAR);
    return frame;
  }

  size_t frameCount() const override { return recording_->frameCount(); }
  std::string description() const override { return recording_->description() + ", rectified"; }

 private:
  void mapPixels(const CameraIntrinsics& camera) {
    const cv::Matx33d matrix(camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0);
    cv::Mat sources;
    cv::initUndistortRectifyMap(matrix, distortion_, cv::noArray(), matrix, {camera.width, camera.height}, CV_32FC2,
                                sources, cv::noArray());
    cv::convertMaps(sources, cv::noArray(), sources_, source_fractions_, CV_16SC2);
    cv::convertMaps(sources, cv::noArray(), nearest_, cv::noArray(), CV_16SC2, true);
  }

  // 0 where the recording's image ends.
  static cv::Mat remapped(const cv::Mat& image, const cv::Mat& sources, cv::InputArray fractions, int interpolation) {
    cv::Mat result;
    cv::remap(image, result, sources, fractions, interpolation, cv::BORDER_CONSTANT);
    return result;
  }

  std::unique_ptr<Recording> recording_;
  std::vector<double> distortion_;
  cv::Mat sources_, source_fractions_;  // of each rectified pixel, in the recording's image, fixed point
  cv::Mat nearest_;                     // the same, rounded
};

}  // namespace

std::unique_ptr<Recording> rectified(std::unique_ptr<Recording> recording, const std::vector<double>& distortion) {
  if (distortion.empty()) return recording;
  return std::make_unique<RectifiedRecording>(std::move(recording), distortion);
}

}  // namespace depth_fusion
