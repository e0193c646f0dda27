#include "depth_fusion/surface_mesh/mesh_picture.h"

#include <array>
#include <cmath>

#include "surface_mesh/triangle_pixels.h"

namespace depth_fusion {
namespace {

constexpr float kNearest_m = 1e-3f;
const cv::Vec3f kBackground(38.0f, 32.0f, 28.0f);
const cv::Vec3f kFront(225.0f, 212.0f, 200.0f);
const cv::Vec3f kTintOfShaded(0.31f, 0.38f, 0.95f);  // red
const cv::Vec3f kTintOfColored(0.4f, 0.4f, 0.4f);
constexpr float kAmbient = 0.15f;
constexpr int kSubpixels = 2;  // each pixel is the mean of 2x2

struct Corner {
  float u, v;                // pixels
  float inverse_depth;       // 1 / z, linear over the picture
  cv::Vec3f color_by_depth;  // BGR / z, too
};

struct Canvas {
  int width, height;
  bool open;                   // what is seen from behind is left out
  cv::Vec3f tint_from_behind;  // factors on a surface's colour
  std::vector<float> inverse_depths;
  std::vector<cv::Vec3f> colours;

  Canvas(int w, int h, bool without_behind, const cv::Vec3f& tint)
      : width(w),
        height(h),
        open(without_behind),
        tint_from_behind(tint),
        inverse_depths(static_cast<size_t>(w) * h, 0.0f),
        colours(static_cast<size_t>(w) * h, kBackground) {}
};

CameraIntrinsics magnified(const CameraIntrinsics& camera, int factor) {
  return {camera.width * factor, camera.height * factor,           camera.fx * factor,
          camera.fy * factor,    (camera.cx + 0.5) * factor - 0.5, (camera.cy + 0.5) * factor - 0.5};
}

// Returns the brightness of a grey surface that is lit from the camera.
float shadeOf(const Eigen::Vector3f& p_C, const Eigen::Vector3f& normal_C) {
  return kAmbient + (1.0f - kAmbient) * std::abs(normal_C.dot(p_C.normalized()));
}

std::vector<Corner> projectVertices(const TriangleMesh& mesh, const CameraIntrinsics& camera,
                                    const Pose& T_W_C, bool colored) {
  const Eigen::Isometry3f T_C_W = T_W_C.inverse().cast<float>();
  std::vector<Corner> corners;
  corners.reserve(mesh.vertices.size());
  for (size_t i = 0; i < mesh.vertices.size(); ++i) {
    const MeshVertex& vertex = mesh.vertices[i];
    const Eigen::Vector3f p_C = T_C_W * vertex.position_W;
    const Eigen::Vector3f normal_C = T_C_W.linear() * vertex.normal_W;
    const float inverse_depth = p_C.z() > kNearest_m ? 1.0f / p_C.z() : 0.0f;
    const cv::Vec3f color = colored ? cv::Vec3f(mesh.colors[i][2], mesh.colors[i][1], mesh.colors[i][0])
                                    : kFront * shadeOf(p_C, normal_C);
    corners.push_back(
        {static_cast<float>(camera.fx) * p_C.x() * inverse_depth + static_cast<float>(camera.cx),
         static_cast<float>(camera.fy) * p_C.y() * inverse_depth + static_cast<float>(camera.cy),
         inverse_depth, color * inverse_depth});
  }
  return corners;
}

void drawTriangle(Canvas& canvas, const Corner (&t)[3]) {
  const std::array<cv::Point2f, 3> pixels = {cv::Point2f(t[0].u, t[0].v), cv::Point2f(t[1].u, t[1].v),
                                             cv::Point2f(t[2].u, t[2].v)};
  const bool is_front = twiceTheArea(pixels[0], pixels[1], pixels[2]) < 0.0f;
  if (canvas.open && !is_front) return;
  forEachPixelOf(pixels, {canvas.width, canvas.height}, 0.0f,
                 [&](const cv::Point& at, const std::array<float, 3>& w) {
                   const float inverse_depth =
                       w[0] * t[0].inverse_depth + w[1] * t[1].inverse_depth + w[2] * t[2].inverse_depth;
                   const size_t pixel = static_cast<size_t>(at.y) * canvas.width + at.x;
                   if (inverse_depth <= canvas.inverse_depths[pixel]) return;
                   canvas.inverse_depths[pixel] = inverse_depth;
                   const cv::Vec3f color_by_depth =
                       w[0] * t[0].color_by_depth + w[1] * t[1].color_by_depth + w[2] * t[2].color_by_depth;
                   const cv::Vec3f color = color_by_depth * (1.0f / inverse_depth);
                   canvas.colours[pixel] = is_front ? color : cv::Vec3f(color.mul(canvas.tint_from_behind));
                 });
}

cv::Mat averaged(const Canvas& canvas, int width, int height) {
  cv::Mat picture(height, width, CV_8UC3);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      cv::Vec3f sum(0.0f, 0.0f, 0.0f);
      for (int i = 0; i < kSubpixels * kSubpixels; ++i) {
        const int row = kSubpixels * v + i / kSubpixels;
        sum += canvas.colours[static_cast<size_t>(row) * canvas.width + kSubpixels * u + i % kSubpixels];
      }
      picture.at<cv::Vec3b>(v, u) = sum / static_cast<float>(kSubpixels * kSubpixels);
    }
  }
  return picture;
}

}  // namespace

cv::Mat renderMesh(const TriangleMesh& mesh, const CameraIntrinsics& camera, const Pose& T_W_C,
                   MeshPaint paint) {
  const bool colored = paint != MeshPaint::kShaded && !mesh.colors.empty();
  const CameraIntrinsics fine = magnified(camera, kSubpixels);
  const std::vector<Corner> corners = projectVertices(mesh, fine, T_W_C, colored);
  Canvas canvas(fine.width, fine.height, paint == MeshPaint::kOpen, colored ? kTintOfColored : kTintOfShaded);
  for (const MeshTriangle& triangle : mesh.triangles) {
    const Corner t[3] = {corners[triangle[0]], corners[triangle[1]], corners[triangle[2]]};
    if (t[0].inverse_depth > 0.0f && t[1].inverse_depth > 0.0f && t[2].inverse_depth > 0.0f)
      drawTriangle(canvas, t);
  }
  return averaged(canvas, camera.width, camera.height);
}

}  // namespace depth_fusion
