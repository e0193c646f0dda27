#include "depth_fusion/compute/device_image.h"

#include <cstring>

#include "depth_fusion/common/error.h"
#include "geometry/kernel_args.h"
#include "geometry/packed_normal.h"

namespace depth_fusion {
namespace {

// The pixels, without guards and padding, in a host copy of an image.
cv::Mat pixelView(std::vector<float>& elements, const CameraIntrinsics& camera) {
  float* first = elements.data() + IMAGE_GUARD;
  return cv::Mat(camera.height, pitchOf(camera.width), CV_32FC1, first).colRange(0, camera.width);
}

}  // namespace

DeviceBuffer zeroImage(ComputeContext& compute, const CameraIntrinsics& camera) {
  DeviceBuffer image(compute, imageElements(camera) * sizeof(float), "images");
  image.fill(0, image.bytes());
  return image;
}

cv::Mat readImage(const DeviceBuffer& image, const CameraIntrinsics& camera) {
  std::vector<float> elements = image.read<float>(imageElements(camera));
  return pixelView(elements, camera).clone();
}

cv::Mat readNormals(const DeviceBuffer& image, const CameraIntrinsics& camera) {
  const cv::Mat words = readImage(image, camera);
  cv::Mat normals(words.size(), CV_32FC3);
  for (int y = 0; y < words.rows; ++y) {
    for (int x = 0; x < words.cols; ++x) {
      uint32_t word = 0;
      std::memcpy(&word, words.ptr<float>(y, x), sizeof(word));
      normals.at<cv::Vec3f>(y, x) = unpackedNormal(word);
    }
  }
  return normals;
}

void writeImage(DeviceBuffer& image, const CameraIntrinsics& camera, const cv::Mat& pixels) {
  check(pixels.type() == CV_32FC1 && pixels.cols == camera.width && pixels.rows == camera.height,
        "writeImage takes float images of the camera's size");
  std::vector<float> elements(imageElements(camera), 0.0f);
  cv::Mat view = pixelView(elements, camera);
  pixels.copyTo(view);
  image.write(elements);
}

}  // namespace depth_fusion
