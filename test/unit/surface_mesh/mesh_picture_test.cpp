#include "depth_fusion/surface_mesh/mesh_picture.h"

#include <gtest/gtest.h>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

// A square of the given half edge at depth z, facing the origin, or away from it.
void addSquare(TriangleMesh& mesh, const Eigen::Vector3f& centre, float half_edge_m, bool facing) {
  const auto first = static_cast<uint32_t>(mesh.vertices.size());
  const Eigen::Vector3f normal(0.0f, 0.0f, facing ? -1.0f : 1.0f);
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3f corner((i & 1) == 0 ? -half_edge_m : half_edge_m,
                                 i < 2 ? -half_edge_m : half_edge_m, 0.0f);
    mesh.vertices.push_back({centre + corner, normal});
  }
  const std::vector<MeshTriangle> towards = {{first, first + 2, first + 1},
                                             {first + 1, first + 2, first + 3}};
  for (MeshTriangle triangle : towards) {
    if (!facing) std::swap(triangle[1], triangle[2]);
    mesh.triangles.push_back(triangle);
  }
}

bool isReddish(const cv::Vec3b& bgr) { return bgr[2] > bgr[0] + 20; }
bool isBackground(const cv::Vec3b& bgr) { return bgr[0] < 60 && bgr[1] < 60 && bgr[2] < 60; }

TEST(MeshPicture, showsTheNearerSurfaceAndItsSide) {
  const CameraIntrinsics camera = {64, 48, 50.0, 50.0, 31.5, 23.5};
  TriangleMesh mesh;
  addSquare(mesh, {0.0f, 0.0f, 1.0f}, 0.1f, false);
  addSquare(mesh, {0.0f, 0.0f, 2.0f}, 0.6f, true);
  addSquare(mesh, {0.0f, 0.0f, -1.0f}, 10.0f, true);
  const cv::Mat picture = renderMesh(mesh, camera, Pose::Identity());
  ASSERT_EQ(picture.size(), cv::Size(64, 48));
  EXPECT_TRUE(isReddish(picture.at<cv::Vec3b>(24, 32)));
  const cv::Vec3b behind = picture.at<cv::Vec3b>(24, 32 + 10);
  EXPECT_FALSE(isReddish(behind));
  EXPECT_FALSE(isBackground(behind));
  EXPECT_TRUE(isBackground(picture.at<cv::Vec3b>(24, 32 + 17)));
}

TEST(MeshPicture, edgesFallOnTheProjectedPixels) {
  const CameraIntrinsics camera = {100, 100, 100.0, 100.0, 49.5, 49.5};
  TriangleMesh mesh;
  addSquare(mesh, {0.0f, 0.0f, 1.0f}, 0.2f, true);
  const cv::Mat picture = renderMesh(mesh, camera, Pose::Identity());
  EXPECT_TRUE(isBackground(picture.at<cv::Vec3b>(50, 29)));
  EXPECT_FALSE(isBackground(picture.at<cv::Vec3b>(50, 30)));
  EXPECT_FALSE(isBackground(picture.at<cv::Vec3b>(50, 69)));
  EXPECT_TRUE(isBackground(picture.at<cv::Vec3b>(50, 70)));
}

TEST(MeshPicture, drawsTheColorsUnlessItIsToShade) {
  const CameraIntrinsics camera = {64, 48, 50.0, 50.0, 31.5, 23.5};
  TriangleMesh mesh;
  addSquare(mesh, {0.0f, 0.0f, 1.0f}, 0.3f, true);
  for (int i = 0; i < 4; ++i) mesh.colors.push_back({static_cast<uint8_t>((i & 1) == 0 ? 40 : 240), 100, 20});
  const cv::Mat picture = renderMesh(mesh, camera, Pose::Identity());
  const cv::Vec3b left = picture.at<cv::Vec3b>(24, 18);
  const cv::Vec3b right = picture.at<cv::Vec3b>(24, 45);
  EXPECT_NEAR(left[0], 20, 1);
  EXPECT_NEAR(left[1], 100, 1);
  EXPECT_NEAR(left[2], 140 - 100 * 13.5 / 15.0, 8);
  EXPECT_NEAR(right[2], 140 + 100 * 13.5 / 15.0, 8);
  const cv::Mat shaded = renderMesh(mesh, camera, Pose::Identity(), MeshPaint::kShaded);
  EXPECT_FALSE(isReddish(shaded.at<cv::Vec3b>(24, 45)));
  EXPECT_GT(shaded.at<cv::Vec3b>(24, 45)[0], 150);
}

TEST(MeshPicture, openLeavesOutWhatIsSeenFromBehind) {
  const CameraIntrinsics camera = {64, 48, 50.0, 50.0, 31.5, 23.5};
  TriangleMesh mesh;
  addSquare(mesh, {0.0f, 0.0f, 1.0f}, 0.5f, false);
  EXPECT_TRUE(
      isBackground(renderMesh(mesh, camera, Pose::Identity(), MeshPaint::kOpen).at<cv::Vec3b>(24, 32)));
  addSquare(mesh, {0.0f, 0.0f, 2.0f}, 0.6f, true);
  mesh.colors.assign(mesh.vertices.size(), {240, 100, 20});
  const cv::Mat picture = renderMesh(mesh, camera, Pose::Identity(), MeshPaint::kOpen);
  EXPECT_EQ(picture.at<cv::Vec3b>(24, 32), cv::Vec3b(20, 100, 240));
}

TEST(MeshPicture, everyViewSeesTheWholeMeshFilled) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3f corner(static_cast<float>(i & 1), static_cast<float>(i >> 1 & 1),
                                 static_cast<float>(i >> 2));
    mesh.vertices.push_back({corner * 2.0f - Eigen::Vector3f(5.0f, 0.0f, 1.0f), Eigen::Vector3f::UnitZ()});
  }
  const CameraIntrinsics camera = pictureCamera(320, 240, 1.0);
  for (const std::string& name : viewNames()) {
    const Pose T_C_W = viewOf(mesh, camera, name).inverse();
    double widest_px = 0.0;
    for (const MeshVertex& vertex : mesh.vertices) {
      const Eigen::Vector3d p = T_C_W * vertex.position_W.cast<double>();
      ASSERT_GT(p.z(), 0.0) << name;
      const double u = camera.fx * p.x() / p.z();
      const double v = camera.fy * p.y() / p.z();
      EXPECT_LE(std::abs(u), camera.cx + 1e-6) << name;
      EXPECT_LE(std::abs(v), camera.cy + 1e-6) << name;
      widest_px = std::max({widest_px, std::abs(u) / camera.cx, std::abs(v) / camera.cy});
    }
    EXPECT_NEAR(widest_px, 1.0, 1e-6) << name;
  }
}

TEST(MeshPicture, topLooksDownAndAutoForward) {
  TriangleMesh mesh;
  addSquare(mesh, {0.0f, 0.0f, 2.0f}, 0.6f, true);
  const CameraIntrinsics camera = pictureCamera(320, 240, 1.0);
  EXPECT_GT((viewOf(mesh, camera, "top").linear() * Eigen::Vector3d::UnitZ()).y(), 0.99);
  const Eigen::Vector3d forward = viewOf(mesh, camera, "auto").linear() * Eigen::Vector3d::UnitZ();
  EXPECT_GT(forward.z(), 0.8);
  EXPECT_GT(forward.y(), 0.2);
}

TEST(MeshPicture, badRequestsAreErrors) {
  const CameraIntrinsics camera = pictureCamera(320, 240, 1.0);
  TriangleMesh mesh;
  EXPECT_THROW(viewOf(mesh, camera, "auto"), Error);
  addSquare(mesh, {0.0f, 0.0f, 2.0f}, 0.6f, true);
  EXPECT_THROW(viewOf(mesh, camera, "sideways"), Error);
}

}  // namespace
}  // namespace depth_fusion
