#include "tools/simulation/renderer.h"

#include <algorithm>

#include "tools/simulation/tile_tracer.h"

namespace depth_fusion {
namespace {

using Eigen::Vector3d;

// Light comes from the ceiling's middle and from all around. It is fixed in L, so that colours do not change
// with the view.
Vector3d shade(const Vector3d& color_bgr, const Vector3d& p_L, const Vector3d& normal_L) {
  const Vector3d light_L(0.3, -0.2, 2.2);
  const double diffuse = std::max(0.0, normal_L.dot((light_L - p_L).normalized()));
  return color_bgr * (0.6 + 0.4 * diffuse);
}

Vector3d colorOf(const Primitive& primitive, const Vector3d& p_W, const Vector3d& normal_W) {
  const Material& material = primitive.material();
  const Vector3d p_L = primitive.T_L_W() * p_W;
  const Vector3d texture = textureColor(material, p_L);
  return material.shaded ? shade(texture, p_L, primitive.T_L_W().linear() * normal_W) : texture;
}

// Renders the part of the view that a tile is.
void renderTile(const Scene& scene, const CameraIntrinsics& camera, const Pose& T_W_D, const cv::Rect& tile,
                RenderedView& view) {
  const TileTracer tracer(scene, camera, T_W_D, tile);
  for (int v = tile.y; v < tile.br().y; ++v) {
    for (int u = tile.x; u < tile.br().x; ++u) {
      const Vector3d ray =
          Vector3d((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1.0).normalized();
      const Hit hit = tracer.trace(T_W_D.linear() * ray);
      if (hit.primitive == nullptr) continue;
      const Vector3d normal_W = hit.primitive->normal(hit.p_W);
      const Vector3d color = colorOf(*hit.primitive, hit.p_W, normal_W);
      if (hit.has_depth) view.depth_m.at<float>(v, u) = static_cast<float>(hit.range_m * ray.z());
      view.cos_incidence.at<float>(v, u) = static_cast<float>(-normal_W.dot(hit.ray_W));
      view.color.at<cv::Vec3b>(v, u) =
          cv::Vec3b(cv::saturate_cast<uchar>(color[0]), cv::saturate_cast<uchar>(color[1]),
                    cv::saturate_cast<uchar>(color[2]));
    }
  }
}

RenderedView emptyView(const CameraIntrinsics& camera) {
  RenderedView view;
  view.depth_m = cv::Mat::zeros(camera.height, camera.width, CV_32FC1);
  view.color = cv::Mat::zeros(camera.height, camera.width, CV_8UC3);
  view.cos_incidence = cv::Mat::zeros(camera.height, camera.width, CV_32FC1);
  return view;
}

}  // namespace

RenderedView render(const Scene& scene, const CameraIntrinsics& camera, const Pose& T_W_D) {
  RenderedView view = emptyView(camera);
  constexpr int kTile_px = 16;
  const cv::Rect image(0, 0, camera.width, camera.height);
  const int columns = (camera.width + kTile_px - 1) / kTile_px;
  const int rows = (camera.height + kTile_px - 1) / kTile_px;
  cv::parallel_for_(cv::Range(0, columns * rows), [&](const cv::Range& tiles) {
    for (int tile = tiles.start; tile < tiles.end; ++tile) {
      const cv::Point corner(tile % columns * kTile_px, tile / columns * kTile_px);
      renderTile(scene, camera, T_W_D, cv::Rect(corner, cv::Size(kTile_px, kTile_px)) & image, view);
    }
  });
  return view;
}

RenderedView renderRows(const Scene& scene, const CameraIntrinsics& camera,
                        const std::function<Pose(int row)>& T_W_D) {
  constexpr int kRowTile_px = 64;
  RenderedView view = emptyView(camera);
  cv::parallel_for_(cv::Range(0, camera.height), [&](const cv::Range& rows) {
    for (int row = rows.start; row < rows.end; ++row) {
      const Pose T_W_row = T_W_D(row);
      for (int u = 0; u < camera.width; u += kRowTile_px) {
        renderTile(scene, camera, T_W_row, {u, row, std::min(kRowTile_px, camera.width - u), 1}, view);
      }
    }
  });
  return view;
}

}  // namespace depth_fusion
