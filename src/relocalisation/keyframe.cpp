#include "depth_fusion/relocalisation/keyframe.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace depth_fusion {
namespace {

constexpr double kThumbnailBlur_px = 2.0;
constexpr int kJpegQuality = 95;

}  // namespace

cv::Mat thumbnailOf(const FrameFeatures& features) {
  cv::Mat thumbnail;
  cv::resize(features.smoothed_levels.back(), thumbnail, cv::Size(kThumbnailWidth_px, kThumbnailHeight_px),
             0.0, 0.0, cv::INTER_AREA);
  thumbnail.convertTo(thumbnail, CV_32F);
  cv::GaussianBlur(thumbnail, thumbnail, cv::Size(), kThumbnailBlur_px);
  thumbnail -= cv::mean(thumbnail)[0];
  const double norm = cv::norm(thumbnail);
  return norm > 0.0 ? cv::Mat(thumbnail / norm) : thumbnail;
}

std::string jpegOf(const cv::Mat& color) {
  std::vector<uchar> bytes;
  cv::imencode(".jpg", color, bytes, {cv::IMWRITE_JPEG_QUALITY, kJpegQuality});
  return {bytes.begin(), bytes.end()};
}

KeyframeColor colorOf(const RgbdFrame& frame) {
  if (!colorProblem(frame).empty()) return {};
  return {jpegOf(frame.color), colorCamera(frame), frame.T_C_D.value_or(Pose::Identity())};
}

Keyframe keyframeOf(const FrameFeatures& features, const Pose& T_W_D, double stamp_s) {
  Keyframe keyframe;
  keyframe.features = features;
  keyframe.features.smoothed_levels.clear();
  keyframe.thumbnail = thumbnailOf(features);
  keyframe.T_W_D = T_W_D;
  keyframe.stamp_s = stamp_s;
  return keyframe;
}

KeyframePtr movedTo(const Pose& T_W_D, const Keyframe& keyframe) {
  auto moved = std::make_shared<Keyframe>(keyframe);
  moved->T_W_D = T_W_D;
  return moved;
}

}  // namespace depth_fusion
