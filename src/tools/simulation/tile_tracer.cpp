#include "tools/simulation/tile_tracer.h"

#include <algorithm>

namespace depth_fusion {
namespace {

using Eigen::Vector3d;

constexpr double kFar_m = 30.0;
constexpr double kClearGlass_cos = 0.7;  // of the angle of incidence up to which light comes through and back
constexpr double kJustAfter = 1.0 + 4e-16;  // makes any number a little larger

// True if a ray meets a box before the range ends.
bool meets(const Eigen::AlignedBox3d& box_W, const Vector3d& origin_W, const Vector3d& ray_W, double end_m) {
  const Eigen::Array3d low = (box_W.min() - origin_W).array() / ray_W.array();
  const Eigen::Array3d high = (box_W.max() - origin_W).array() / ray_W.array();
  const double enter_m = low.min(high).maxCoeff(), leave_m = low.max(high).minCoeff();
  return enter_m <= leave_m && leave_m >= 0.0 && enter_m < end_m;
}

// The four planes through the eye that hold the rays of a part of the image, with normals inwards.
class Beam {
 public:
  Beam(const CameraIntrinsics& camera, const Pose& T_W_D, const cv::Rect& tile)
      : eye_W_(T_W_D.translation()) {
    const double left = (tile.x - 1 - camera.cx) / camera.fx, right = (tile.br().x - camera.cx) / camera.fx;
    const double top = (tile.y - 1 - camera.cy) / camera.fy, bottom = (tile.br().y - camera.cy) / camera.fy;
    normals_W_ << T_W_D.linear() * Vector3d(1, 0, -left), T_W_D.linear() * Vector3d(-1, 0, right),
        T_W_D.linear() * Vector3d(0, 1, -top), T_W_D.linear() * Vector3d(0, -1, bottom);
  }

  // True of all boxes that the beam meets, and of a few more.
  bool mayMeet(const Eigen::AlignedBox3d& box_W) const {
    const Vector3d centre = box_W.center() - eye_W_, half = 0.5 * box_W.sizes();
    return ((normals_W_.transpose() * centre).array() >= -(normals_W_.cwiseAbs().transpose() * half).array())
        .all();
  }

 private:
  Vector3d eye_W_;
  Eigen::Matrix<double, 3, 4> normals_W_;
};

Hit hitAt(const Primitive* primitive, double range_m, const Vector3d& origin_W, const Vector3d& ray_W) {
  return {primitive, range_m, origin_W + range_m * ray_W, ray_W};
}

// Traces a ray that comes from a solid, which is left out.
Hit traceFrom(const Primitive* sender, const Scene& scene, const Vector3d& origin_W, const Vector3d& ray_W) {
  const Primitive* nearest = nullptr;
  double nearest_m = kFar_m;
  const auto enter = [&](const Eigen::AlignedBox3d& box_W) {
    return meets(box_W, origin_W, ray_W, nearest_m);
  };
  scene.tree().visit(enter, [&](int i) {
    const Primitive* primitive = &scene.primitives()[i];
    if (primitive == sender) return;
    const std::optional<double> range_m = primitive->firstHit(origin_W, ray_W, nearest_m);
    if (!range_m) return;
    nearest = primitive;
    nearest_m = *range_m;
  });
  return hitAt(nearest, nearest_m, origin_W, ray_W);
}

// Follows a ray that has met a mirror or glass.
Hit goOn(const Scene& scene, const Hit& pane) {
  const Vector3d normal_W = pane.primitive->normal(pane.p_W);
  const double towards = -normal_W.dot(pane.ray_W);
  const bool mirror = pane.primitive->material().optics == Optics::kMirror;
  const Vector3d ray_W = mirror ? Vector3d(pane.ray_W + 2.0 * towards * normal_W) : pane.ray_W;
  Hit behind = traceFrom(pane.primitive, scene, pane.p_W, ray_W);
  behind.range_m += pane.range_m;
  behind.has_depth = mirror || towards > kClearGlass_cos;
  return behind;
}

}  // namespace

TileTracer::TileTracer(const Scene& scene, const CameraIntrinsics& camera, const Pose& T_W_D,
                       const cv::Rect& tile)
    : scene_(scene), eye_W_(T_W_D.translation()) {
  const Beam beam(camera, T_W_D, tile);
  const auto enter = [&](const Eigen::AlignedBox3d& box_W) {
    return beam.mayMeet(box_W) && box_W.exteriorDistance(eye_W_) < kFar_m;
  };
  scene.tree().visit(enter, [&](int i) {
    const Primitive& primitive = scene.primitives()[i];
    candidates_.push_back({&primitive, primitive.boundingBox_W().exteriorDistance(eye_W_)});
  });
  std::sort(candidates_.begin(), candidates_.end(),
            [](const Candidate& a, const Candidate& b) { return a.near_m < b.near_m; });
}

Hit TileTracer::trace(const Vector3d& ray_W) const {
  const Hit hit = firstHit(ray_W);
  const bool opaque = hit.primitive == nullptr || hit.primitive->material().optics == Optics::kOpaque;
  return opaque ? hit : goOn(scene_, hit);
}

// Of two solids that are hit at the same range, the first of the scene counts.
Hit TileTracer::firstHit(const Vector3d& ray_W) const {
  const Primitive* nearest = nullptr;
  double nearest_m = kFar_m;
  for (const Candidate& candidate : candidates_) {
    if (candidate.near_m > nearest_m) break;
    const std::optional<double> range_m =
        candidate.primitive->firstHit(eye_W_, ray_W, kJustAfter * nearest_m);
    if (range_m && (*range_m < nearest_m || candidate.primitive < nearest)) {
      nearest = candidate.primitive;
      nearest_m = *range_m;
    }
  }
  return hitAt(nearest, nearest_m, eye_W_, ray_W);
}

}  // namespace depth_fusion
