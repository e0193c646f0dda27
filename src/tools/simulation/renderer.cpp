#include "tools/simulation/renderer.h"

#include <algorithm>
#include <cmath>

namespace depth_fusion {
namespace {

using Eigen::Vector3d;

constexpr int kTile_px = 16;
constexpr double kFar_m = 30.0;

using Primitives = std::vector<const Primitive*>;

struct Hit {
  const Primitive* primitive = nullptr;  // null: nothing is hit
  double range_m = 0.0;
};

Hit trace(const Primitives& primitives, const Vector3d& origin_W, const Vector3d& ray_W) {
  Hit nearest{nullptr, kFar_m};
  for (const Primitive* primitive : primitives) {
    const std::optional<double> range_m = primitive->firstHit(origin_W, ray_W, nearest.range_m);
    if (range_m) nearest = {primitive, *range_m};
  }
  return nearest;
}

// Light comes from the ceiling's middle and from all around. It is fixed in W, so that colours do not change
// with the view.
Vector3d shade(const Vector3d& color_bgr, const Vector3d& p_W, const Vector3d& normal_W) {
  const Vector3d light_W(0.3, -0.2, 2.2);
  const double diffuse = std::max(0.0, normal_W.dot((light_W - p_W).normalized()));
  return color_bgr * (0.6 + 0.4 * diffuse);
}

class TileRenderer {
 public:
  TileRenderer(const Scene& scene, const CameraIntrinsics& camera, const Pose& T_W_D, RenderedView& view)
      : scene_(scene), camera_(camera), T_W_D_(T_W_D), view_(view) {}

  void render(const cv::Rect& tile) const {
    const Primitives primitives = primitivesIn(tile);
    for (int v = tile.y; v < tile.br().y; ++v) {
      for (int u = tile.x; u < tile.br().x; ++u) renderPixel(primitives, u, v);
    }
  }

 private:
  Vector3d ray_D(double u, double v) const {
    return Vector3d((u - camera_.cx) / camera_.fx, (v - camera_.cy) / camera_.fy, 1.0).normalized();
  }

  // Finds the primitives that rays of the tile can hit: those whose bounding sphere meets the cone around the
  // tile.
  Primitives primitivesIn(const cv::Rect& tile) const {
    const Vector3d axis_D = ray_D(tile.x + tile.width / 2.0, tile.y + tile.height / 2.0);
    const Vector3d axis_W = T_W_D_.linear() * axis_D;
    double cone_rad = 0.0;
    for (const int u : {tile.x, tile.br().x}) {
      for (const int v : {tile.y, tile.br().y}) {
        cone_rad = std::max(cone_rad, std::acos(std::min(1.0, axis_D.dot(ray_D(u, v)))));
      }
    }
    Primitives primitives;
    for (const Primitive& primitive : scene_.primitives()) {
      const double radius_m = primitive.boundingRadius();
      const Vector3d centre = primitive.centre_W() - T_W_D_.translation();
      const double range_m = centre.norm();
      const bool meets =
          range_m <= radius_m || std::acos(std::clamp(axis_W.dot(centre) / range_m, -1.0, 1.0)) <=
                                     cone_rad + std::asin(radius_m / range_m);
      if (meets) primitives.push_back(&primitive);
    }
    return primitives;
  }

  void renderPixel(const Primitives& primitives, int u, int v) const {
    const Vector3d ray = ray_D(u, v);
    const Vector3d ray_W = T_W_D_.linear() * ray;
    const Hit hit = trace(primitives, T_W_D_.translation(), ray_W);
    if (hit.primitive == nullptr) return;
    const Vector3d p_W = T_W_D_.translation() + hit.range_m * ray_W;
    const Vector3d normal_W = hit.primitive->normal(p_W);
    const Material& material = hit.primitive->material();
    const Vector3d texture = textureColor(material, p_W);
    const Vector3d color = material.shaded ? shade(texture, p_W, normal_W) : texture;
    view_.depth_m.at<float>(v, u) = static_cast<float>(hit.range_m * ray.z());
    view_.cos_incidence.at<float>(v, u) = static_cast<float>(-normal_W.dot(ray_W));
    view_.color.at<cv::Vec3b>(v, u) =
        cv::Vec3b(cv::saturate_cast<uchar>(color[0]), cv::saturate_cast<uchar>(color[1]),
                  cv::saturate_cast<uchar>(color[2]));
  }

  const Scene& scene_;
  const CameraIntrinsics& camera_;
  const Pose& T_W_D_;
  RenderedView& view_;
};

}  // namespace

RenderedView render(const Scene& scene, const CameraIntrinsics& camera, const Pose& T_W_D) {
  RenderedView view;
  view.depth_m = cv::Mat::zeros(camera.height, camera.width, CV_32FC1);
  view.color = cv::Mat::zeros(camera.height, camera.width, CV_8UC3);
  view.cos_incidence = cv::Mat::zeros(camera.height, camera.width, CV_32FC1);
  const TileRenderer renderer(scene, camera, T_W_D, view);
  const cv::Rect image(0, 0, camera.width, camera.height);
  const int columns = (camera.width + kTile_px - 1) / kTile_px;
  const int rows = (camera.height + kTile_px - 1) / kTile_px;
  cv::parallel_for_(cv::Range(0, columns * rows), [&](const cv::Range& tiles) {
    for (int tile = tiles.start; tile < tiles.end; ++tile) {
      const cv::Point corner(tile % columns * kTile_px, tile / columns * kTile_px);
      renderer.render(cv::Rect(corner, cv::Size(kTile_px, kTile_px)) & image);
    }
  });
  return view;
}

}  // namespace depth_fusion
