#include "texture_odometry/patch_alignment.h"

#include <cmath>

namespace depth_fusion {
namespace {

using Eigen::Vector2d;

constexpr int kSide = 2 * kPatchRadius_px + 1;
constexpr int kMaxIterations = 8;
constexpr double kConvergence_px = 0.02;
constexpr double kMaxShift_px = 3.0;
constexpr float kMinCorrelation = 0.8f;

using Values = Eigen::Array<float, kSide * kSide, 1>;

// The patch without its border and mean, and its gradients.
struct Template {
  Values values, gradient_x, gradient_y;
};

Template templateOf(const FeaturePatch& patch) {
  Template result;
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      const uint8_t* pixel = &patch[(row + 1) * kPatchSize_px + column + 1];
      const int i = row * kSide + column;
      result.values[i] = pixel[0];
      result.gradient_x[i] = 0.5f * (pixel[1] - pixel[-1]);
      result.gradient_y[i] = 0.5f * (pixel[kPatchSize_px] - pixel[-kPatchSize_px]);
    }
  }
  for (Values* values : {&result.values, &result.gradient_x, &result.gradient_y}) *values -= values->mean();
  return result;
}

bool insideImage(const cv::Mat& image, const Vector2d& centre) {
  const double margin = kPatchRadius_px + 1.0;
  return centre.x() >= margin && centre.y() >= margin && centre.x() < image.cols - 1 - margin &&
         centre.y() < image.rows - 1 - margin;
}

// Samples the patch bilinearly and subtracts its mean.
Values sample(const cv::Mat& image, const Vector2d& centre) {
  const int left = static_cast<int>(centre.x()) - kPatchRadius_px;
  const int top = static_cast<int>(centre.y()) - kPatchRadius_px;
  const float fx = static_cast<float>(centre.x() - std::floor(centre.x()));
  const float fy = static_cast<float>(centre.y() - std::floor(centre.y()));
  const float w00 = (1 - fx) * (1 - fy), w01 = fx * (1 - fy), w10 = (1 - fx) * fy, w11 = fx * fy;
  Values values;
  for (int row = 0; row < kSide; ++row) {
    const uint8_t* upper = image.ptr<uint8_t>(top + row) + left;
    const uint8_t* lower = image.ptr<uint8_t>(top + row + 1) + left;
    for (int column = 0; column < kSide; ++column) {
      values[row * kSide + column] =
          w00 * upper[column] + w01 * upper[column + 1] + w10 * lower[column] + w11 * lower[column + 1];
    }
  }
  return values - values.mean();
}

}  // namespace

std::optional<Vector2d> alignPatch(const FeaturePatch& patch, const cv::Mat& smoothed,
                                   const Vector2d& start) {
  const Template target = templateOf(patch);
  Eigen::Matrix2f hessian;
  hessian(0, 0) = target.gradient_x.square().sum();
  hessian(1, 1) = target.gradient_y.square().sum();
  hessian(0, 1) = hessian(1, 0) = (target.gradient_x * target.gradient_y).sum();
  if (!(hessian.determinant() > 1.0f)) return std::nullopt;
  const Eigen::Matrix2f inverse = hessian.inverse();

  Vector2d centre = start;
  for (int i = 0; i < kMaxIterations; ++i) {
    if (!insideImage(smoothed, centre)) return std::nullopt;
    const Values values = sample(smoothed, centre);
    const Values difference = values - target.values;
    const Eigen::Vector2f step = inverse * Eigen::Vector2f((target.gradient_x * difference).sum(),
                                                           (target.gradient_y * difference).sum());
    centre -= step.cast<double>();
    if ((centre - start).norm() > kMaxShift_px) return std::nullopt;
    if (step.norm() > kConvergence_px) continue;
    const float correlation =
        (values * target.values).sum() / std::sqrt(values.square().sum() * target.values.square().sum());
    return correlation > kMinCorrelation ? std::make_optional(centre) : std::nullopt;
  }
  return std::nullopt;
}

}  // namespace depth_fusion
