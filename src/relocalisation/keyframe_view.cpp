#include "depth_fusion/relocalisation/keyframe_view.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "depth_fusion/common/error.h"
#include "store/packed_row.h"

namespace depth_fusion {
namespace {

constexpr float kStep_m = 0.00025f;
constexpr float kLargestStep = 65535.0f;
constexpr float kSameSurface = 1.03f;  // how much farther than the nearest a pixel of the same surface is

uint16_t stepsOf(float depth_m) {
  const float steps = depth_m / kStep_m;
  return steps > 0.0f && steps <= kLargestStep ? static_cast<uint16_t>(std::lround(steps)) : uint16_t{0};
}

// Differences along the rows, their low bytes before their high ones: most of the latter are alike.
std::string differencesOf(const cv::Mat& depth_m) {
  const size_t count = depth_m.total();
  std::string bytes(2 * count, '\0');
  size_t i = 0;
  for (int v = 0; v < depth_m.rows; ++v) {
    uint16_t last = 0;
    for (int u = 0; u < depth_m.cols; ++u, ++i) {
      const uint16_t steps = stepsOf(depth_m.at<float>(v, u));
      const auto difference = static_cast<uint16_t>(steps - last);
      bytes[i] = static_cast<char>(difference & 0xff);
      bytes[count + i] = static_cast<char>(difference >> 8);
      last = steps;
    }
  }
  return bytes;
}

size_t bytesOf(const CameraIntrinsics& camera) {
  return 2 * static_cast<size_t>(camera.width) * static_cast<size_t>(camera.height);
}

float nearestMean(const float (&depths)[4]) {
  float nearest = 0.0f;
  for (const float depth : depths) {
    if (depth > 0.0f && (nearest == 0.0f || depth < nearest)) nearest = depth;
  }
  float sum = 0.0f;
  int count = 0;
  for (const float depth : depths) {
    if (!(depth > 0.0f && depth <= kSameSurface * nearest)) continue;
    sum += depth;
    ++count;
  }
  return count > 0 ? sum / static_cast<float>(count) : 0.0f;
}

}  // namespace

cv::Mat halvedDepth(const cv::Mat& depth_m) {
  cv::Mat half(depth_m.rows / 2, depth_m.cols / 2, CV_32FC1);
  for (int v = 0; v < half.rows; ++v) {
    const auto *upper = depth_m.ptr<float>(2 * v), *lower = depth_m.ptr<float>(2 * v + 1);
    for (int u = 0; u < half.cols; ++u)
      half.at<float>(v, u) = nearestMean({upper[2 * u], upper[2 * u + 1], lower[2 * u], lower[2 * u + 1]});
  }
  return half;
}

KeyframeView::KeyframeView(const cv::Mat& depth_m, const CameraIntrinsics& camera, int max_width_px)
    : camera_(camera) {
  check(depth_m.type() == CV_32FC1 && depth_m.cols == camera.width && depth_m.rows == camera.height,
        "a keyframe's view is " + sizeText(depth_m.cols, depth_m.rows) + " pixels of another kind than its " +
            "camera's " + sizeText(camera.width, camera.height));
  check(max_width_px > 0, "a keyframe's view needs a width");
  cv::Mat small = depth_m;
  while (small.cols > max_width_px) {
    small = halvedDepth(small);
    camera_ = halved(camera_);
  }
  packed_ = depth_fusion::packed(differencesOf(small));
}

KeyframeView::KeyframeView(const CameraIntrinsics& camera, std::string packed, const std::string& where)
    : camera_(camera), packed_(std::move(packed)) {
  if (packed_.empty()) return;
  check(unpacked(packed_, where).size() == bytesOf(camera), where + " has a view of another size");
}

cv::Mat KeyframeView::depth() const {
  if (isEmpty()) return {};
  const std::string bytes = unpacked(packed_, "a keyframe's view");
  const size_t count = bytes.size() / 2;
  cv::Mat depth_m(camera_.height, camera_.width, CV_32FC1);
  size_t i = 0;
  for (int v = 0; v < depth_m.rows; ++v) {
    uint16_t steps = 0;
    for (int u = 0; u < depth_m.cols; ++u, ++i) {
      const unsigned difference =
          static_cast<uint8_t>(bytes[i]) | static_cast<unsigned>(static_cast<uint8_t>(bytes[count + i])) << 8;
      steps = static_cast<uint16_t>(steps + difference);
      depth_m.at<float>(v, u) = kStep_m * static_cast<float>(steps);
    }
  }
  return depth_m;
}

}  // namespace depth_fusion
