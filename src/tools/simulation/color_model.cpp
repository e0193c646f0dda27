#include "tools/simulation/color_model.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace depth_fusion {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kFar_m = 30.0;  // of what has no depth
constexpr double kMaxGain = 4.0;

Vector3d bilinear(const cv::Mat& image, const Vector2d& at) {
  const double u = std::clamp(at.x(), 0.0, image.cols - 1.001);
  const double v = std::clamp(at.y(), 0.0, image.rows - 1.001);
  const int column = static_cast<int>(u), row = static_cast<int>(v);
  const double right = u - column, down = v - row;
  const auto level = [&](int below, int beside) {
    const cv::Vec3b& bgr = image.at<cv::Vec3b>(row + below, column + beside);
    return Vector3d(bgr[0], bgr[1], bgr[2]);
  };
  return (1.0 - down) * ((1.0 - right) * level(0, 0) + right * level(0, 1)) +
         down * ((1.0 - right) * level(1, 0) + right * level(1, 1));
}

Vector2d project(const CameraIntrinsics& camera, const Vector3d& p_D) {
  const double z = std::max(p_D.z(), 1e-3);
  return {camera.fx * p_D.x() / z + camera.cx, camera.fy * p_D.y() / z + camera.cy};
}

// Takes the mean along the way that each point makes in the image.
cv::Mat blurred(const RenderedView& view, const CameraIntrinsics& camera, const ExposureMotion& motion) {
  constexpr double kSharp_px = 0.5;
  constexpr double kMaxSamples = 24.0;
  cv::Mat image = view.color.clone();
  cv::parallel_for_(cv::Range(0, image.rows), [&](const cv::Range& rows) {
    for (int v = rows.start; v < rows.end; ++v) {
      for (int u = 0; u < image.cols; ++u) {
        const double z_m = view.depth_m.at<float>(v, u) > 0.0f ? view.depth_m.at<float>(v, u) : kFar_m;
        const Vector3d p_D(z_m * (u - camera.cx) / camera.fx, z_m * (v - camera.cy) / camera.fy, z_m);
        const Vector2d begin = project(camera, motion.T_begin_D * p_D);
        const Vector2d way = project(camera, motion.T_end_D * p_D) - begin;
        if (way.norm() < kSharp_px) continue;
        const int samples = static_cast<int>(std::min(kMaxSamples, 2.0 + way.norm()));
        Vector3d sum = Vector3d::Zero();
        for (int i = 0; i < samples; ++i) sum += bilinear(view.color, begin + way * (i / (samples - 1.0)));
        const Vector3d mean = sum / samples;
        image.at<cv::Vec3b>(v, u) =
            cv::Vec3b(cv::saturate_cast<uchar>(mean[0]), cv::saturate_cast<uchar>(mean[1]),
                      cv::saturate_cast<uchar>(mean[2]));
      }
    }
  });
  return image;
}

void expose(cv::Mat& image, double target_level) {
  const cv::Scalar mean = cv::mean(image);
  const double level = (mean[0] + mean[1] + mean[2]) / 3.0;
  image.convertTo(image, -1, std::clamp(target_level / std::max(level, 1.0), 1.0 / kMaxGain, kMaxGain));
}

void addNoise(cv::Mat& image, const ColorModel& model, uint64_t seed) {
  cv::RNG random((seed + 1) * 0x94d049bb133111ebull);
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      for (uchar& level : image.at<cv::Vec3b>(v, u).val) {
        const double sigma = std::sqrt(model.read_sigma * model.read_sigma + model.shot_gain * level);
        level = cv::saturate_cast<uchar>(level + random.gaussian(sigma));
      }
    }
  }
}

}  // namespace

ColorModel videoCamera() {
  ColorModel model;
  model.exposure_s = 1.0 / 60.0;
  model.target_level = 110.0;
  model.read_sigma = 2.0;
  model.shot_gain = 0.08;
  return model;
}

cv::Mat senseColor(const RenderedView& view, const ColorModel& model, const CameraIntrinsics& camera,
                   const ExposureMotion& motion, uint64_t seed) {
  cv::Mat image = model.exposure_s > 0.0 ? blurred(view, camera, motion) : view.color.clone();
  if (model.target_level > 0.0) expose(image, model.target_level);
  if (model.read_sigma > 0.0 || model.shot_gain > 0.0) addNoise(image, model, seed);
  return image;
}

}  // namespace depth_fusion
