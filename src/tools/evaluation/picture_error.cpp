#include "tools/evaluation/picture_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "color_fusion/color_alignment.h"
#include "color_fusion/exposure.h"
#include "texturing/view_image.h"

namespace depth_fusion {

namespace {

// What the mesh looks like from there.
std::vector<SurfaceColor> colorsSeen(const TexturedMesh& mesh, const CameraIntrinsics& camera,
                                     const Pose& T_W_C) {
  constexpr double kMostPoints = 30000.0;  // for pictures of any size
  constexpr double kFullWeight = 16.0;
  const int stride_px = std::max(
      3, static_cast<int>(std::sqrt(static_cast<double>(camera.width) * camera.height / kMostPoints)));
  const TexturedPicture seen = renderTexturedMesh(mesh, camera, T_W_C);
  std::vector<SurfaceColor> colors;
  for (int v = 0; v < camera.height; v += stride_px) {
    for (int u = 0; u < camera.width; u += stride_px) {
      const double z = static_cast<double>(seen.depth.at<float>(v, u));
      if (z == 0.0) continue;
      const cv::Vec3b& bgr = seen.color.at<cv::Vec3b>(v, u);
      const Eigen::Vector3d p_C((u - camera.cx) / camera.fx * z, (v - camera.cy) / camera.fy * z, z);
      colors.push_back({T_W_C * p_C, Eigen::Array3d(bgr[0], bgr[1], bgr[2]), kFullWeight});
    }
  }
  return colors;
}

}  // namespace

Pose fittedPose(const TexturedMesh& mesh, const TexturingView& view) {
  constexpr int kRounds = 5;
  constexpr double kConverged_px = 0.1;
  ColorImage image{view.camera, {}};
  cv::cvtColor(imageOf(view), image.bgra, cv::COLOR_BGR2BGRA);
  Pose T_C_W = view.T_W_C.inverse();
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<SurfaceColor> surface = colorsSeen(mesh, view.camera, T_C_W.inverse());
    const Eigen::Array3d gain = exposureGain(surface, image, T_C_W).value_or(Eigen::Array3d::Ones());
    const Pose aligned = orthonormalized(alignColor(surface, image, gain, T_C_W));
    const double moved_px = twistFromPose(aligned * T_C_W.inverse()).norm() * view.camera.fx;
    T_C_W = aligned;
    if (moved_px < kConverged_px) break;
  }
  return T_C_W.inverse();
}

PictureError comparePictures(const cv::Mat& predicted, const cv::Mat& picture, const cv::Mat& covered) {
  constexpr int kBorder_px = 5;
  cv::Mat inner;
  cv::erode(covered, inner, cv::Mat::ones(kBorder_px, kBorder_px, CV_8U), cv::Point(-1, -1), 1,
            cv::BORDER_CONSTANT, cv::Scalar(0));
  std::array<double, 3> products{}, squares{}, picture_squares{};
  PictureError error;
  for (int v = 0; v < picture.rows; ++v) {
    for (int u = 0; u < picture.cols; ++u) {
      if (inner.at<uint8_t>(v, u) == 0) continue;
      ++error.pixels;
      for (int i = 0; i < 3; ++i) {
        const double is = picture.at<cv::Vec3b>(v, u)[i], thought = predicted.at<cv::Vec3b>(v, u)[i];
        products[i] += is * thought;
        squares[i] += thought * thought;
        picture_squares[i] += is * is;
      }
    }
  }
  if (error.pixels == 0) return error;
  // With the best scale, products / squares, this is what is left of the squared differences.
  double left = 0.0;
  for (int i = 0; i < 3; ++i)
    left += picture_squares[i] - (squares[i] > 0.0 ? products[i] * products[i] / squares[i] : 0.0);
  error.psnr_db =
      10.0 * std::log10(255.0 * 255.0 * 3.0 * static_cast<double>(error.pixels) / std::max(left, 1e-9));
  return error;
}

}  // namespace depth_fusion
