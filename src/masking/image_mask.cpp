#include "depth_fusion/masking/image_mask.h"

#include <algorithm>
#include <cmath>

#include "depth_fusion/common/error.h"
#include "masking/depth_pixels.h"

namespace depth_fusion {
namespace {

constexpr double kMaxStretch =
    1.02;  // by which a mask may be higher than its camera's images, beside its scale

void checkMask(const cv::Mat& mask, const CameraIntrinsics& camera) {
  check(mask.type() == CV_8UC1 && !mask.empty(), "a mask must be an image of one channel of 8 bits");
  const double wider = static_cast<double>(mask.cols) / camera.width;
  const double higher = static_cast<double>(mask.rows) / camera.height;
  check(wider < kMaxStretch * higher && higher < kMaxStretch * wider,
        "a mask is " + sizeText(mask.cols, mask.rows) + ", the images of its camera are " +
            sizeText(camera.width, camera.height) + "; it must have their shape");
}

// Where along an axis of the mask a place between -0.5 and size - 0.5 in the camera's image lies.
int scaled(double place, int mask_size, int size) {
  return static_cast<int>(std::floor((place + 0.5) * mask_size / size));
}

// As the same camera sees it.
void maskSameView(RgbdFrame& frame, const cv::Mat& mask) {
  for (int y = 0; y < frame.depth.rows; ++y) {
    const uint8_t* row = mask.ptr<uint8_t>(scaled(y, mask.rows, frame.depth.rows));
    for (int x = 0; x < frame.depth.cols; ++x) {
      if (row[scaled(x, mask.cols, frame.depth.cols)] != 0) clearDepth(frame.depth, x, y);
    }
  }
}

void maskFromColor(RgbdFrame& frame, const cv::Mat& mask, const CameraIntrinsics& color) {
  const Pose T_C_D = frame.T_C_D.value_or(Pose::Identity());
  for (int y = 0; y < frame.depth.rows; ++y) {
    for (int x = 0; x < frame.depth.cols; ++x) {
      const double z = depthAt_m(frame, x, y);
      if (!(z > 0.0)) continue;
      const Eigen::Vector3d p_C = T_C_D * pointAt(frame.intrinsics, x, y, z);
      if (p_C.z() <= 0.0) continue;
      const int u = scaled(color.fx * p_C.x() / p_C.z() + color.cx, mask.cols, color.width);
      const int v = scaled(color.fy * p_C.y() / p_C.z() + color.cy, mask.rows, color.height);
      if (u < 0 || v < 0 || u >= mask.cols || v >= mask.rows) continue;
      if (mask.at<uint8_t>(v, u) != 0) clearDepth(frame.depth, x, y);
    }
  }
}

}  // namespace

void applyMask(RgbdFrame& frame, const cv::Mat& mask, MaskView view) {
  const bool is_other_view = view == MaskView::kColor && (frame.T_C_D || frame.color_intrinsics);
  const CameraIntrinsics camera = is_other_view ? colorCamera(frame) : frame.intrinsics;
  checkMask(mask, camera);
  frame.depth = frame.depth.clone();
  is_other_view ? maskFromColor(frame, mask, camera) : maskSameView(frame, mask);
}

}  // namespace depth_fusion
