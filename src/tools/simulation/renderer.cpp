#include "tools/simulation/renderer.h"

#include <algorithm>
#include <cmath>

namespace depth_fusion {
namespace {

using Eigen::Vector3d;

constexpr int kTile_px = 16;
constexpr double kFar_m = 30.0;
constexpr double kClearGlass_cos = 0.7;  // of the angle of incidence up to which light comes through and back
constexpr double kJustAfter = 1.0 + 4e-16;  // makes any number a little larger

struct Candidate {
  const Primitive* primitive;
  double near_m;  // no ray meets it before
};

struct Hit {
  const Primitive* primitive = nullptr;  // null: nothing is hit
  double range_m = 0.0;
};

// Candidates are sorted by near_m. Of two that are hit at the same range, the first of the scene counts.
Hit trace(const std::vector<Candidate>& candidates, const Vector3d& origin_W, const Vector3d& ray_W) {
  Hit nearest{nullptr, kFar_m};
  for (const Candidate& candidate : candidates) {
    if (candidate.near_m > nearest.range_m) break;
    const std::optional<double> range_m =
        candidate.primitive->firstHit(origin_W, ray_W, kJustAfter * nearest.range_m);
    if (range_m && (*range_m < nearest.range_m || candidate.primitive < nearest.primitive)) {
      nearest = {candidate.primitive, *range_m};
    }
  }
  return nearest;
}

// True if a ray meets a box before the range ends.
bool meets(const Eigen::AlignedBox3d& box_W, const Vector3d& origin_W, const Vector3d& ray_W, double end_m) {
  const Eigen::Array3d low = (box_W.min() - origin_W).array() / ray_W.array();
  const Eigen::Array3d high = (box_W.max() - origin_W).array() / ray_W.array();
  const double enter_m = low.min(high).maxCoeff(), leave_m = low.max(high).minCoeff();
  return enter_m <= leave_m && leave_m >= 0.0 && enter_m < end_m;
}

// Traces a ray that does not come from the eye; what sent it on is left out.
Hit trace(const Scene& scene, const Vector3d& origin_W, const Vector3d& ray_W, const Primitive* sender) {
  Hit nearest{nullptr, kFar_m};
  const auto enter = [&](const Eigen::AlignedBox3d& box_W) {
    return meets(box_W, origin_W, ray_W, nearest.range_m);
  };
  scene.tree().visit(enter, [&](int i) {
    const Primitive* primitive = &scene.primitives()[i];
    if (primitive == sender) return;
    const std::optional<double> range_m = primitive->firstHit(origin_W, ray_W, nearest.range_m);
    if (range_m) nearest = {primitive, *range_m};
  });
  return nearest;
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

class TileRenderer {
 public:
  TileRenderer(const Scene& scene, const CameraIntrinsics& camera, const Pose& T_W_D, RenderedView& view)
      : scene_(scene), camera_(camera), T_W_D_(T_W_D), view_(view) {}

  void render(const cv::Rect& tile) const {
    const std::vector<Candidate> candidates = candidatesIn(tile);
    for (int v = tile.y; v < tile.br().y; ++v) {
      for (int u = tile.x; u < tile.br().x; ++u) renderPixel(candidates, u, v);
    }
  }

 private:
  Vector3d ray_D(double u, double v) const {
    return Vector3d((u - camera_.cx) / camera_.fx, (v - camera_.cy) / camera_.fy, 1.0).normalized();
  }

  // Finds the primitives that rays of the tile can hit.
  std::vector<Candidate> candidatesIn(const cv::Rect& tile) const {
    const Beam beam(camera_, T_W_D_, tile);
    const auto enter = [&](const Eigen::AlignedBox3d& box_W) {
      return beam.mayMeet(box_W) && box_W.exteriorDistance(T_W_D_.translation()) < kFar_m;
    };
    std::vector<Candidate> candidates;
    scene_.tree().visit(enter, [&](int i) {
      const Primitive& primitive = scene_.primitives()[i];
      candidates.push_back({&primitive, primitive.boundingBox_W().exteriorDistance(T_W_D_.translation())});
    });
    std::sort(candidates.begin(), candidates.end(),
              [](const Candidate& a, const Candidate& b) { return a.near_m < b.near_m; });
    return candidates;
  }

  void renderPixel(const std::vector<Candidate>& candidates, int u, int v) const {
    const Vector3d ray = ray_D(u, v);
    Vector3d ray_W = T_W_D_.linear() * ray;
    Hit hit = trace(candidates, T_W_D_.translation(), ray_W);
    Vector3d p_W = T_W_D_.translation() + hit.range_m * ray_W;
    bool has_depth = true;
    if (hit.primitive != nullptr && hit.primitive->material().optics != Optics::kOpaque) {
      const Primitive& pane = *hit.primitive;
      const Vector3d normal_W = pane.normal(p_W);
      if (pane.material().optics == Optics::kMirror) {
        ray_W -= 2.0 * normal_W.dot(ray_W) * normal_W;
      } else {
        has_depth = -normal_W.dot(ray_W) > kClearGlass_cos;
      }
      const Hit behind = trace(scene_, p_W, ray_W, &pane);
      p_W += behind.range_m * ray_W;
      hit = {behind.primitive, hit.range_m + behind.range_m};
    }
    if (hit.primitive == nullptr) return;
    const Vector3d normal_W = hit.primitive->normal(p_W);
    const Vector3d color = colorOf(*hit.primitive, p_W, normal_W);
    if (has_depth) view_.depth_m.at<float>(v, u) = static_cast<float>(hit.range_m * ray.z());
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

RenderedView renderRows(const Scene& scene, const CameraIntrinsics& camera,
                        const std::function<Pose(int row)>& T_W_D) {
  constexpr int kRowTile_px = 64;
  RenderedView view = emptyView(camera);
  cv::parallel_for_(cv::Range(0, camera.height), [&](const cv::Range& rows) {
    for (int row = rows.start; row < rows.end; ++row) {
      const Pose T_W_row = T_W_D(row);
      const TileRenderer renderer(scene, camera, T_W_row, view);
      for (int u = 0; u < camera.width; u += kRowTile_px) {
        renderer.render({u, row, std::min(kRowTile_px, camera.width - u), 1});
      }
    }
  });
  return view;
}

}  // namespace depth_fusion
