#include "depth_fusion/geometry/camera_check.h"

#include <cmath>
#include <sstream>

namespace depth_fusion {
namespace {

constexpr double kLeastFocalShare = 0.134;  // of the image's size: 150 degrees

bool isFocalLength(double focal_px, int size_px) { return focal_px >= kLeastFocalShare * size_px; }

bool isInside(double principal_px, int size_px) { return principal_px > 0.0 && principal_px < size_px - 1; }

}  // namespace

std::string cameraProblem(const CameraIntrinsics& camera) {
  std::ostringstream text;
  const bool finite = std::isfinite(camera.fx) && std::isfinite(camera.fy) && std::isfinite(camera.cx) &&
                      std::isfinite(camera.cy);
  if (camera.width <= 0 || camera.height <= 0) {
    text << "a size of " << sizeText(camera.width, camera.height) << " is none";
  } else if (!finite) {
    text << "a focal length or the principal point is no number";
  } else if (!isFocalLength(camera.fx, camera.width) || !isFocalLength(std::abs(camera.fy), camera.height)) {
    text << "focal lengths of " << camera.fx << " and " << camera.fy << " pixels are none for a "
         << sizeText(camera.width, camera.height) << " image";
  } else if (!isInside(camera.cx, camera.width) || !isInside(camera.cy, camera.height)) {
    text << "the principal point (" << camera.cx << ", " << camera.cy << ") is not within the "
         << sizeText(camera.width, camera.height) << " image";
  }
  return text.str();
}

}  // namespace depth_fusion
