#include "depth_fusion/compute/device_image.h"

#include "depth_fusion/common/error.h"
#include "geometry/kernel_args.h"

namespace depth_fusion {
namespace {

// The pixels, without guards and padding, of one plane in a host copy of an image.
cv::Mat planeView(std::vector<float>& elements, const CameraIntrinsics& camera, int plane) {
  float* first = elements.data() + plane * planeElements(camera) + IMAGE_GUARD;
  return cv::Mat(camera.height, pitchOf(camera.width), CV_32FC1, first).colRange(0, camera.width);
}

}  // namespace

DeviceBuffer zeroImage(ComputeContext& compute, const CameraIntrinsics& camera, int planes) {
  DeviceBuffer image(compute, planes * planeElements(camera) * sizeof(float), "images");
  image.fill(0, image.bytes());
  return image;
}

cv::Mat readImage(const DeviceBuffer& image, const CameraIntrinsics& camera, int planes) {
  std::vector<float> elements = image.read<float>(planes * planeElements(camera));
  std::vector<cv::Mat> channels;
  for (int plane = 0; plane < planes; ++plane) channels.push_back(planeView(elements, camera, plane));
  cv::Mat merged;
  cv::merge(channels, merged);
  return merged;
}

void writeImage(DeviceBuffer& image, const CameraIntrinsics& camera, const cv::Mat& channels) {
  check(channels.depth() == CV_32F && channels.cols == camera.width && channels.rows == camera.height,
        "writeImage takes float images of the camera's size");
  std::vector<float> elements(channels.channels() * planeElements(camera), 0.0f);
  for (int plane = 0; plane < channels.channels(); ++plane) {
    cv::Mat view = planeView(elements, camera, plane);
    cv::extractChannel(channels, view, plane);
  }
  image.write(elements);
}

}  // namespace depth_fusion
