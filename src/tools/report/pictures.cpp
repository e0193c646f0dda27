#include "tools/report/pictures.h"

#include <algorithm>

#include "depth_fusion/surface_mesh/mesh_picture.h"
#include "tools/report/html.h"
#include "tools/report/level.h"

namespace depth_fusion {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kRise_rad = 0.3;   // above the view that is called "auto"
constexpr double kTurn_rad = 0.35;  // of the first picture, so that walls are seen aslant

CameraIntrinsics camera() { return pictureCamera(720, 540, kPi / 3.0); }
CameraIntrinsics wideCamera() { return pictureCamera(720, 540, 1.3); }

std::string figure(const cv::Mat& picture, const std::string& caption) {
  return "<figure><img alt=\"" + escaped(caption) + "\" src=\"" + jpegAddress(picture) + "\"><figcaption>" +
         escaped(caption) + "</figcaption></figure>\n";
}

// Those that show a surface; the background is dark.
int filledPixels(const cv::Mat& picture) {
  cv::Mat background;
  cv::inRange(picture, cv::Scalar(0, 0, 0), cv::Scalar(45, 40, 36), background);
  return static_cast<int>(picture.total()) - cv::countNonZero(background);
}

cv::Mat fromAbove(const TriangleMesh& mesh, double turn_rad) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(kRise_rad, Eigen::Vector3d::UnitX()) *
                               Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const TriangleMesh turned = rotated(turn, mesh);
  return renderMesh(turned, camera(), viewOf(turned, camera(), "auto"), MeshPaint::kOpen);
}

}  // namespace

std::string pictureFigures(const TriangleMesh& mesh, const Trajectory& trajectory) {
  constexpr int kSides = 4, kEyes = 2;
  std::vector<cv::Mat> sides;
  for (int side = 0; side < kSides; ++side)
    sides.push_back(fromAbove(mesh, 2.0 * kPi * side / kSides + kTurn_rad));
  int most = 0;
  for (const cv::Mat& side : sides) most = std::max(most, filledPixels(side));
  std::string figures;
  for (const cv::Mat& side : sides) {
    if (2 * filledPixels(side) >= most) figures += figure(side, "from above");
  }
  for (size_t eye = 1; eye <= kEyes && !trajectory.empty(); ++eye) {
    const StampedPose& pose = trajectory[(trajectory.size() - 1) * eye / kEyes];
    const double after_s = pose.stamp_s - trajectory.front().stamp_s;
    figures += figure(renderMesh(mesh, wideCamera(), pose.T_W_D),
                      "from where the sensor was after " + fixed(after_s, 1) + " s");
  }
  return figures;
}

std::string pictureFigure(const TriangleMesh& mesh, const std::string& caption) {
  return figure(fromAbove(mesh, kTurn_rad), caption);
}

}  // namespace depth_fusion
