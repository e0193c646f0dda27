#include "texturing/view_image.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "common/io/image_file.h"
#include "depth_fusion/common/error.h"

namespace depth_fusion {

cv::Mat imageOf(const TexturingView& view) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(view.image.data());
  cv::Mat image = decodeColorImage(bytes, view.image.size(), "a picture for the texture");
  check(image.cols == view.camera.width && image.rows == view.camera.height,
        "a picture for the texture is " + sizeText(image.cols, image.rows) + ", its camera's are " +
            sizeText(view.camera.width, view.camera.height));
  if (image.channels() == 1) cv::cvtColor(image, image, cv::COLOR_GRAY2BGR);
  return image;
}

Eigen::Vector3f projected(const Eigen::Vector3f& p_C, const CameraIntrinsics& camera) {
  if (p_C.z() <= 0.0f) return {0.0f, 0.0f, 0.0f};
  return {static_cast<float>(camera.fx) * p_C.x() / p_C.z() + static_cast<float>(camera.cx),
          static_cast<float>(camera.fy) * p_C.y() / p_C.z() + static_cast<float>(camera.cy), p_C.z()};
}

Eigen::Array3f sampled(const cv::Mat& image, float u, float v) {
  const int x = std::min(static_cast<int>(u), image.cols - 2),
            y = std::min(static_cast<int>(v), image.rows - 2);
  const float fx = u - static_cast<float>(x), fy = v - static_cast<float>(y);
  const auto at = [&](int row, int column) {
    const cv::Vec3b& pixel = image.at<cv::Vec3b>(row, column);
    return Eigen::Array3f(pixel[0], pixel[1], pixel[2]);
  };
  return (1.0f - fy) * ((1.0f - fx) * at(y, x) + fx * at(y, x + 1)) +
         fy * ((1.0f - fx) * at(y + 1, x) + fx * at(y + 1, x + 1));
}

bool isInside(const Eigen::Vector3f& uvz, const CameraIntrinsics& camera, float margin_px) {
  return uvz.z() > 0.0f && uvz.x() >= margin_px && uvz.y() >= margin_px &&
         uvz.x() <= static_cast<float>(camera.width - 1) - margin_px &&
         uvz.y() <= static_cast<float>(camera.height - 1) - margin_px;
}

}  // namespace depth_fusion
