#include <array>

#include "depth_fusion/texturing/textured_mesh.h"
#include "surface_mesh/triangle_pixels.h"
#include "texturing/view_image.h"

namespace depth_fusion {

TexturedPicture renderTexturedMesh(const TexturedMesh& mesh, const CameraIntrinsics& camera,
                                   const Pose& T_W_C) {
  const Eigen::Isometry3f T_C_W = T_W_C.inverse().cast<float>();
  std::vector<Eigen::Vector3f> pixels;
  pixels.reserve(mesh.mesh.vertices.size());
  for (const MeshVertex& vertex : mesh.mesh.vertices)
    pixels.push_back(projected(T_C_W * vertex.position_W, camera));
  TexturedPicture picture{cv::Mat(camera.height, camera.width, CV_8UC3, cv::Scalar::all(0)),
                          cv::Mat(camera.height, camera.width, CV_32FC1, cv::Scalar(0))};
  size_t page = 0;
  for (size_t face = 0; face < mesh.mesh.triangles.size(); ++face) {
    while (face >= mesh.page_ends[page]) ++page;
    const MeshTriangle& t = mesh.mesh.triangles[face];
    std::array<cv::Point2f, 3> corners;
    std::array<float, 3> inverse{};
    for (int i = 0; i < 3; ++i) {
      corners[i] = {pixels[t[i]].x(), pixels[t[i]].y()};
      inverse[i] = pixels[t[i]].z() > 0.0f ? 1.0f / pixels[t[i]].z() : 0.0f;
    }
    if (inverse[0] == 0.0f || inverse[1] == 0.0f || inverse[2] == 0.0f) continue;
    const bool is_front = twiceTheArea(corners[0], corners[1], corners[2]) < 0.0f;
    forEachPixelOf(corners, picture.depth.size(), 0.0f,
                   [&](const cv::Point& at, const std::array<float, 3>& w) {
                     const float depth = 1.0f / (w[0] * inverse[0] + w[1] * inverse[1] + w[2] * inverse[2]);
                     float& nearest = picture.depth.at<float>(at);
                     if (nearest > 0.0f && depth >= nearest) return;
                     nearest = depth;
                     Eigen::Vector2f place = Eigen::Vector2f::Zero();
                     for (int i = 0; i < 3; ++i) place += w[i] * inverse[i] * depth * mesh.places[t[i]];
                     const Eigen::Array3f color =
                         is_front ? sampled(mesh.pages[page], place.x(), place.y()) : Eigen::Array3f::Zero();
                     for (int i = 0; i < 3; ++i)
                       picture.color.at<cv::Vec3b>(at)[i] = cv::saturate_cast<uint8_t>(color[i]);
                   });
  }
  return picture;
}

}  // namespace depth_fusion
