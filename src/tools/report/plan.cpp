// The sensor's way over the model from above.
#include <algorithm>
#include <array>

#include "common/io/formatted_line.h"
#include "depth_fusion/common/percentile.h"
#include "depth_fusion/surface_mesh/mesh_picture.h"
#include "tools/plots/nice_step.h"
#include "tools/report/charts.h"
#include "tools/report/html.h"
#include "tools/report/pictures.h"

namespace depth_fusion {
namespace {

constexpr int kWidth_px = 1000, kHeight_px = 760;
constexpr double kView_rad = 0.06;  // from so far above that it is a plan
constexpr size_t kMostPoints = 3000;

struct Plan {
  CameraIntrinsics camera;
  Pose T_C_W;

  Eigen::Vector2d pixelOf(const Pose& T_W_D) const {
    const Eigen::Vector3d p_C = T_C_W * T_W_D.translation();
    return {camera.fx * p_C.x() / p_C.z() + camera.cx, camera.fy * p_C.y() / p_C.z() + camera.cy};
  }
};

// From where nearly all of the mesh is seen, and all of the ways.
Plan planAround(const TriangleMesh& mesh, const std::array<const Trajectory*, 2>& ways) {
  constexpr size_t kVerticesLookedAt = 50000;
  constexpr double kSeen = 0.99, kMargin = 1.06;
  std::array<std::vector<double>, 3> coordinates;
  for (size_t i = 0; i < mesh.vertices.size(); i += 1 + mesh.vertices.size() / kVerticesLookedAt) {
    for (size_t axis = 0; axis < 3; ++axis)
      coordinates[axis].push_back(mesh.vertices[i].position_W[static_cast<int>(axis)]);
  }
  Eigen::AlignedBox3d box;
  for (const double part : {(1.0 - kSeen) / 2.0, (1.0 + kSeen) / 2.0})
    box.extend(Eigen::Vector3d(percentile(coordinates[0], part), percentile(coordinates[1], part),
                               percentile(coordinates[2], part)));
  for (const Trajectory* way : ways) {
    for (const StampedPose& pose : *way) box.extend(pose.T_W_D.translation());
  }
  const CameraIntrinsics camera = pictureCamera(kWidth_px, kHeight_px, kView_rad);
  const double width_m = std::max({box.sizes().x(), box.sizes().z() * kWidth_px / kHeight_px, 0.01});
  Pose T_W_C = Pose::Identity();
  T_W_C.linear() << 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -1.0, 0.0;
  T_W_C.translation() = box.center();
  T_W_C.translation().y() -= kMargin * width_m * camera.fx / kWidth_px;
  return {camera, T_W_C.inverse()};
}

std::string polyline(const std::string& points, const char* color, double width, bool dashed = false) {
  return line(
             "<polyline fill=\"none\" stroke=\"%s\" stroke-width=\"%.1f\" stroke-linejoin=\"round\"%s "
             "points=\"",
             color, width, dashed ? " stroke-dasharray=\"7 7\"" : "") +
         points + "\"/>\n";
}

std::string pointText(const Eigen::Vector2d& pixel) { return line("%.1f,%.1f", pixel.x(), pixel.y()); }

// The worst state of the frames after the one with the stamp `from_s` and up to `to_s`. The frames are looked
// at in turn, from `next` on.
TrackingStatus stateBetween(const std::vector<RecordedFrame>& frames, size_t& next, double to_s) {
  TrackingStatus worst = TrackingStatus::kTracking;
  for (; next < frames.size() && frames[next].stamp_s <= to_s; ++next)
    worst = std::max(worst, frames[next].status);
  return worst;
}

std::string drawnWay(const Plan& plan, const Trajectory& trajectory,
                     const std::vector<RecordedFrame>& frames) {
  std::string lines, points;
  const size_t stride = 1 + trajectory.size() / kMostPoints;
  size_t next_frame = 0;
  TrackingStatus state = stateBetween(frames, next_frame, trajectory.front().stamp_s);
  const auto finish = [&] {
    if (!points.empty()) lines += polyline(points, colorOf(state), 3.5, state == TrackingStatus::kLost);
  };
  for (size_t i = 0; i < trajectory.size(); i += stride) {
    const std::string point = pointText(plan.pixelOf(trajectory[i].T_W_D));
    const TrackingStatus now = stateBetween(frames, next_frame, trajectory[i].stamp_s);
    if (now != state && i > 0) {
      finish();
      points = pointText(plan.pixelOf(trajectory[i - stride].T_W_D));
    }
    state = now;
    points += point;
  }
  finish();
  return lines;
}

std::string scaleBar(double pixels_per_m) {
  const double length_m = niceStep(1.2 * kWidth_px / pixels_per_m);
  const std::string text = length_m < 1.0 ? fixed(100.0 * length_m, 0) + " cm" : fixed(length_m, 0) + " m";
  return line("<rect x=\"24\" y=\"%d\" width=\"%.1f\" height=\"8\" fill=\"#fff\"/>", kHeight_px - 34,
              length_m * pixels_per_m) +
         line("<text x=\"24\" y=\"%d\" font-size=\"28\" fill=\"#fff\">", kHeight_px - 46) + text +
         "</text>\n";
}

std::string mark(const Eigen::Vector2d& pixel, const char* color) {
  return line("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"9\" fill=\"%s\" stroke=\"#fff\" stroke-width=\"3\"/>",
              pixel.x(), pixel.y(), color);
}

}  // namespace

std::string planOf(const TriangleMesh& mesh, const Trajectory& trajectory, const Trajectory& truth,
                   const std::vector<RecordedFrame>& frames) {
  const Plan plan = planAround(mesh, {&trajectory, &truth});
  std::string svg = line("<svg class=\"plan\" viewBox=\"0 0 %d %d\">", kWidth_px, kHeight_px) +
                    line("<image width=\"%d\" height=\"%d\"", kWidth_px, kHeight_px) + "href=\"" +
                    jpegAddress(renderMesh(mesh, plan.camera, plan.T_C_W.inverse(), MeshPaint::kOpen)) +
                    "\"/>\n";
  if (!truth.empty()) {
    std::string points;
    for (size_t i = 0; i < truth.size(); i += 1 + truth.size() / kMostPoints)
      points += pointText(plan.pixelOf(truth[i].T_W_D));
    svg += polyline(points, "#ffffff", 7.0);
  }
  if (!trajectory.empty()) {
    const double depth_m = (plan.T_C_W * trajectory.front().T_W_D.translation()).z();
    svg += drawnWay(plan, trajectory, frames) + scaleBar(plan.camera.fx / depth_m) +
           mark(plan.pixelOf(trajectory.back().T_W_D), "#1d242c") +
           mark(plan.pixelOf(trajectory.front().T_W_D), "#2f6fb2");
  }
  return svg + "</svg>\n";
}

}  // namespace depth_fusion
