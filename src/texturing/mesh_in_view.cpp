#include "texturing/mesh_in_view.h"

#include <limits>
#include <opencv2/imgproc.hpp>

#include "surface_mesh/triangle_pixels.h"

namespace depth_fusion {
namespace {

constexpr int kReach_px = 5;  // of the neighbourhood, across
constexpr float kNothing = std::numeric_limits<float>::infinity();

cv::Mat depthOf(const TriangleMesh& mesh, const std::vector<Eigen::Vector3f>& pixels, const cv::Size& size) {
  cv::Mat depth(size, CV_32FC1, cv::Scalar(kNothing));
  for (const MeshTriangle& t : mesh.triangles) {
    std::array<cv::Point2f, 3> corners;
    std::array<float, 3> inverse{};
    bool in_front = true;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3f& uvz = pixels[t[i]];
      in_front = in_front && uvz.z() > 0.0f;
      corners[i] = {uvz.x(), uvz.y()};
      inverse[i] = 1.0f / uvz.z();
    }
    if (!in_front) continue;
    forEachPixelOf(corners, size, 0.0f, [&](const cv::Point& at, const std::array<float, 3>& w) {
      float& nearest = depth.at<float>(at);
      nearest = std::min(nearest, 1.0f / (w[0] * inverse[0] + w[1] * inverse[1] + w[2] * inverse[2]));
    });
  }
  return depth;
}

float at(const cv::Mat& image, const Eigen::Vector3f& uvz) {
  return image.at<float>(cvRound(uvz.y()), cvRound(uvz.x()));
}

}  // namespace

MeshInView::MeshInView(const TriangleMesh& mesh, const TexturingView& view, float hidden_ratio)
    : hidden_ratio_(hidden_ratio) {
  const Eigen::Isometry3f T_C_W = view.T_W_C.inverse().cast<float>();
  pixels_.reserve(mesh.vertices.size());
  for (const MeshVertex& vertex : mesh.vertices)
    pixels_.push_back(projected(T_C_W * vertex.position_W, view.camera));
  const cv::Mat depth = depthOf(mesh, pixels_, {view.camera.width, view.camera.height});
  const cv::Mat about = cv::getStructuringElement(cv::MORPH_RECT, {kReach_px, kReach_px});
  cv::erode(depth, nearest_, about);
  cv::dilate(depth, farthest_, about);
}

bool MeshInView::sees(const Eigen::Vector3f& uvz) const {
  return uvz.z() <= at(nearest_, uvz) * (1.0f + hidden_ratio_);
}

bool MeshInView::isAtOutline(const Eigen::Vector3f& uvz) const {
  return at(farthest_, uvz) > uvz.z() * (1.0f + hidden_ratio_);
}

}  // namespace depth_fusion
