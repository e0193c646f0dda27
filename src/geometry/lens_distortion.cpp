#include "depth_fusion/geometry/lens_distortion.h"

#include <algorithm>
#include <cmath>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

constexpr double kRadiusStep = 1e-3;
constexpr double kMaxRadius = 5.0;  // 79 degrees from the axis

// How far from the axis the ray at radius r comes to lie.
double distortedRadius(LensDistortion k, double r) {
  k.resize(8, 0.0);
  const double r2 = r * r;
  return r * (1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]))) / (1.0 + r2 * (k[5] + r2 * (k[6] + r2 * k[7])));
}

// The distance of the image's nearest border from the axis, at depth 1.
double borderRadius(const CameraIntrinsics& camera) {
  return std::min(std::min(camera.cx, camera.width - 1 - camera.cx) / camera.fx,
                  std::min(camera.cy, camera.height - 1 - camera.cy) / camera.fy);
}

// The distance of the image's farthest corner from the axis, at depth 1.
double cornerRadius(const CameraIntrinsics& camera) {
  const double x = std::max(camera.cx, camera.width - 1 - camera.cx) / camera.fx;
  const double y = std::max(camera.cy, camera.height - 1 - camera.cy) / camera.fy;
  return std::hypot(x, y);
}

}  // namespace

bool distorts(const LensDistortion& lens) {
  return std::any_of(lens.begin(), lens.end(), [](double coefficient) { return coefficient != 0.0; });
}

void checkDistortion(const LensDistortion& lens) {
  const size_t count = lens.size();
  check(count == 0 || count == 4 || count == 5 || count == 8 || count == 12 || count == 14,
        "lens distortion has 4, 5 or 8 coefficients (k1 k2 p1 p2 k3 k4 k5 k6), with thin prism and tilt 12 "
        "or 14, "
        "not " +
            std::to_string(count));
  check(std::all_of(lens.begin(), lens.end(), [](double coefficient) { return std::isfinite(coefficient); }),
        "lens distortion has a coefficient that is no number");
}

void checkDepthLens(const LensDistortion& lens, const std::string& name) {
  checkDistortion(lens);
  check(lens.size() <= 8 || !distorts({lens.begin() + 8, lens.end()}),
        name +
            ": thin prism and tilt of the lens (s1 ... ty) are not taken out of depth; calibrate with at "
            "most 8 coefficients, or give rectified depth");
}

double maxSquaredRadius(const CameraIntrinsics& camera, const LensDistortion& lens, const std::string& name) {
  const double corner = cornerRadius(camera);
  double radius = 0.0, distorted = 0.0;
  while (distorted < corner && radius < kMaxRadius) {
    const double next = distortedRadius(lens, radius + kRadiusStep);
    if (!(next > distorted)) break;
    radius += kRadiusStep;
    distorted = next;
  }
  check(distorted >= std::min(corner, borderRadius(camera)),
        name + ": the lens distortion folds the image " + std::to_string(std::lround(distorted * camera.fx)) +
            " pixels from its middle and cannot be undone; calibrate the camera again");
  return radius * radius;
}

}  // namespace depth_fusion
