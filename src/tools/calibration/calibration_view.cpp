#include "tools/calibration/calibration_view.h"

#include <algorithm>
#include <cmath>

#include "depth_fusion/compute/device_image.h"
#include "depth_fusion/preprocessing/depth_correction.h"
#include "depth_fusion/preprocessing/depth_preprocessor.h"
#include "shared/types.h"

namespace depth_fusion {
namespace {

constexpr int kLevel = 1;  // half the size: a quarter of the pixels, with less noise

}  // namespace

CalibrationView::CalibrationView(DepthPreprocessor& preprocessor, const CalibrationFrame& frame)
    : velocity_(frame.velocity) {
  const DepthLevel& level = preprocessor.process(frame.frame, frame.velocity).levels[kLevel];
  camera_ = level.camera;
  sensor_ = level.sensor;
  depth_m_ = readImage(level.depth, camera_);
  normals_ = readNormals(level.normals, camera_);
}

std::optional<ViewPoint> CalibrationView::at(int x, int y) const {
  if (x < 0 || y < 0 || x >= camera_.width || y >= camera_.height) return std::nullopt;
  const double z = depth_m_.at<float>(y, x);
  const cv::Vec3f& normal = normals_.at<cv::Vec3f>(y, x);
  if (z <= 0.0 || normal[2] == 0.0f) return std::nullopt;
  return ViewPoint{{x, y},
                   {z * (x - camera_.cx) / camera_.fx, z * (y - camera_.cy) / camera_.fy, z},
                   {normal[0], normal[1], normal[2]},
                   AXIAL_SIGMA_M(sensor_, z)};
}

std::optional<ViewPoint> CalibrationView::under(const Eigen::Vector3d& p_D) const {
  if (p_D.z() <= 0.0) return std::nullopt;
  return at(static_cast<int>(std::lround(camera_.fx * p_D.x() / p_D.z() + camera_.cx)),
            static_cast<int>(std::lround(camera_.fy * p_D.y() / p_D.z() + camera_.cy)));
}

std::vector<ViewPoint> CalibrationView::sample(int columns) const {
  const int step_px = std::max(camera_.width / columns, 1);
  std::vector<ViewPoint> points;
  for (int y = step_px / 2; y < camera_.height; y += step_px) {
    for (int x = step_px / 2; x < camera_.width; x += step_px) {
      if (const auto point = at(x, y)) points.push_back(*point);
    }
  }
  return points;
}

void CalibrationView::addDerivatives(const ViewPoint& point, const Eigen::Vector3d& covector,
                                     SparseRow& row) const {
  const GridPlace place =
      placeOnGrid(point.pixel.x, point.pixel.y, {camera_.width, camera_.height}, {kGridColumns, kGridRows});
  const double by_offset = -point.p_D.z() * covector.dot(point.p_D);
  for (int i = 0; i < 4; ++i) row.add(place.indices[i], place.parts[i] * by_offset);
  const double time_per_readout = (point.pixel.y + 0.5) / camera_.height - 1.0;
  const Eigen::Vector3d speed = velocity_.head<3>().cross(point.p_D) + velocity_.tail<3>();
  row.add(kReadoutIndex, time_per_readout * covector.dot(speed));
}

}  // namespace depth_fusion
