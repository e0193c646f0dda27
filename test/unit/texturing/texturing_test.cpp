#include "depth_fusion/texturing/texturing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "depth_fusion/surface_mesh/mesh_picture.h"
#include "support/expect_error.h"
#include "support/painted_wall.h"
#include "tools/evaluation/picture_error.h"

namespace depth_fusion {
namespace {

// Nine pictures from 0.9 m.
std::vector<Pose> posesBeforeTheWall() {
  std::vector<Pose> poses;
  for (const double y_m : {-0.2, 0.0, 0.2}) {
    for (const double x_m : {-0.3, 0.0, 0.3}) poses.push_back(PaintedWall::poseAt(x_m, y_m, 0.9, -0.4 * x_m));
  }
  return poses;
}

// A camera that sees the wall as it is painted, a pixel each.
CameraIntrinsics paintingsCamera(const PaintedWall& wall) {
  const cv::Size size = wall.painting().size();
  const double focal_px = 100.0 / PaintedWall::kPixel_m;  // from 100 m, as good as parallel
  return {size.width, size.height, focal_px, focal_px, (size.width - 1) / 2.0, (size.height - 1) / 2.0};
}

cv::Mat seenLikeThePainting(const PaintedWall& wall, const TexturedMesh& mesh) {
  return renderTexturedMesh(mesh, paintingsCamera(wall), PaintedWall::poseAt(0, 0, 100.0, 0)).color;
}

// In percent of the range.
double meanError(const cv::Mat& a, const cv::Mat& b) {
  cv::Mat difference;
  cv::absdiff(a, b, difference);
  const cv::Scalar mean = cv::mean(difference);
  return (mean[0] + mean[1] + mean[2]) / 3.0 / 2.55;
}

// Takes the pictures once for all tests.
class WallTexturing : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    for (const Pose& pose : posesBeforeTheWall()) {
      pictures_.push_back(wall_.picture(pose));
      views_.push_back(PaintedWall::viewOf(pictures_.back(), pose));
    }
    textured_ = textured(views_);
  }

  // Fewer rounds and points than usual do where the poses are right.
  static TexturingParameters quick(int alignment_rounds = 2) {
    TexturingParameters parameters;
    parameters.alignment_rounds = alignment_rounds;
    parameters.alignment_points = 10000;
    return parameters;
  }
  static Texturing textured(const std::vector<TexturingView>& views,
                            const TexturingParameters& parameters = quick()) {
    return textureMesh(wall_.mesh(0.02), views, parameters);
  }
  std::string readText(const cv::Mat& picture) const {
    std::string text;
    for (size_t i = 0; i < PaintedWall::text().size(); ++i) text += PaintedWall::read(picture, i);
    return text;
  }

  inline static const PaintedWall wall_;
  inline static std::vector<cv::Mat> pictures_;
  inline static std::vector<TexturingView> views_;
  inline static Texturing textured_;  // by these views
};

TEST_F(WallTexturing, lettersOfThreeCentimetresAreRead) {
  ASSERT_EQ(readText(wall_.painting()), PaintedWall::text());
  const Texturing& result = textured_;
  EXPECT_EQ(result.report.seen, result.report.faces);
  EXPECT_NEAR(result.report.seen_area, 1.0, 1e-9);
  const cv::Mat picture = seenLikeThePainting(wall_, result.textured);
  EXPECT_LE(meanError(picture, wall_.painting()), 4.0);
  EXPECT_EQ(readText(picture), PaintedWall::text());
  const cv::Mat by_vertices =
      renderMesh(wall_.mesh(0.005), paintingsCamera(wall_), PaintedWall::poseAt(0, 0, 100.0, 0));
  EXPECT_GT(comparePictures(picture, wall_.painting(), cv::Mat::ones(picture.size(), CV_8U)).psnr_db,
            comparePictures(by_vertices, wall_.painting(), cv::Mat::ones(picture.size(), CV_8U)).psnr_db);
}

TEST_F(WallTexturing, posesThatAreOffAreRefined) {
  std::vector<TexturingView> views = views_;
  for (size_t i = 0; i < views.size(); ++i) {
    const auto angle = static_cast<double>(2 * i);
    views[i].T_W_C.translation() += 0.005 * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0);
  }
  const Texturing before = textured(views, quick(0)), after = textured(views, quick(8));
  EXPECT_LT(after.report.misfit_after, 0.5 * after.report.misfit_before);
  EXPECT_NEAR(after.report.misfit_before, before.report.misfit_after, 1e-6);
  EXPECT_GT(after.report.move_m, 0.003);
  EXPECT_LT(meanError(seenLikeThePainting(wall_, after.textured), wall_.painting()),
            0.8 * meanError(seenLikeThePainting(wall_, before.textured), wall_.painting()));
}

TEST_F(WallTexturing, exposureIsLevelled) {
  const std::vector<Pose> poses = posesBeforeTheWall();
  std::vector<TexturingView> views;
  for (size_t i = 0; i < poses.size(); ++i) {
    cv::Mat picture = pictures_[i].clone();
    picture *= i % 2 == 0 ? 0.8 : 1.1;
    views.push_back(PaintedWall::viewOf(picture, poses[i]));
  }
  const Texturing result = textured(views);
  EXPECT_GT(result.report.patches, 1u);
  EXPECT_LE(result.report.seam_step, 1.5 * result.report.seam_gradient);
  const cv::Mat picture = seenLikeThePainting(wall_, result.textured);
  const cv::Mat everywhere = cv::Mat::ones(picture.size(), CV_8U);
  const double psnr_db = comparePictures(picture, wall_.painting(), everywhere).psnr_db;
  const double even_db =
      comparePictures(seenLikeThePainting(wall_, textured_.textured), wall_.painting(), everywhere).psnr_db;
  EXPECT_GT(psnr_db, even_db - 1.0);
}

TEST_F(WallTexturing, whoWentByIsLeftOut) {
  const std::vector<Pose> poses = posesBeforeTheWall();
  std::vector<TexturingView> views = views_;
  cv::Mat with_person = pictures_[4].clone();
  cv::rectangle(with_person, {250, 100, 120, 380}, cv::Scalar(20, 20, 220), cv::FILLED);
  cv::randu(with_person(cv::Rect(250, 100, 120, 380)), cv::Scalar(0, 0, 180), cv::Scalar(60, 60, 255));
  views[4] = PaintedWall::viewOf(with_person, poses[4]);
  TexturingParameters any_color = quick();
  any_color.outlier_levels = 255.0f;
  const Texturing result = textured(views);
  EXPECT_GT(result.report.outliers, 100u);
  EXPECT_LE(meanError(seenLikeThePainting(wall_, result.textured), wall_.painting()), 4.0);
  EXPECT_GT(meanError(seenLikeThePainting(wall_, textured(views, any_color).textured), wall_.painting()),
            4.0);
}

TEST_F(WallTexturing, unseenFacesHaveTheirVerticesColors) {
  const Pose pose = PaintedWall::poseAt(-0.5, 0.0, 0.5, 0.0);
  const Texturing result = textured({PaintedWall::viewOf(wall_.picture(pose), pose)});
  EXPECT_LT(result.report.seen_area, 0.6);
  EXPECT_GT(result.report.seen_area, 0.1);
  const TriangleMesh mesh = wall_.mesh(0.02);
  size_t far_right = 0;
  const std::vector<MeshVertex>& vertices = result.textured.mesh.vertices;
  for (size_t i = 0; i < vertices.size(); ++i) {
    if (vertices[i].position_W.x() < 0.4f) continue;
    ++far_right;
    const Eigen::Vector2f& place = result.textured.places[i];
    const cv::Vec3b& bgr = result.textured.pages[0].at<cv::Vec3b>(cvRound(place.y()), cvRound(place.x()));
    for (size_t k = 0; k < mesh.vertices.size(); ++k) {
      if (mesh.vertices[k].position_W != vertices[i].position_W) continue;
      EXPECT_EQ((MeshColor{bgr[2], bgr[1], bgr[0]}), mesh.colors[k]);
    }
  }
  EXPECT_GT(far_right, 100u);
}

TEST_F(WallTexturing, facesThatAreHiddenGetNoPictureOfWhatHidesThem) {
  TriangleMesh mesh = wall_.mesh(0.02);
  const auto first = static_cast<uint32_t>(mesh.vertices.size());  // a green board before the wall
  for (const Eigen::Vector3f& p : {Eigen::Vector3f(-0.1f, -0.1f, -0.2f), Eigen::Vector3f(0.1f, -0.1f, -0.2f),
                                   Eigen::Vector3f(0.1f, 0.1f, -0.2f), Eigen::Vector3f(-0.1f, 0.1f, -0.2f)}) {
    mesh.vertices.push_back({p, -Eigen::Vector3f::UnitZ()});
    mesh.colors.push_back({0, 255, 0});
  }
  mesh.triangles.push_back({first, first + 2, first + 1});
  mesh.triangles.push_back({first, first + 3, first + 2});
  const Pose pose = PaintedWall::poseAt(0.0, 0.0, 0.9, 0.0);
  cv::Mat picture = wall_.picture(pose);
  cv::rectangle(picture, {cvRound(319.5 - 75), cvRound(239.5 - 75), 150, 150}, cv::Scalar(0, 255, 0),
                cv::FILLED);
  const Texturing result = textureMesh(mesh, {PaintedWall::viewOf(picture, pose)}, {});
  TexturedMesh wall = result.textured;  // without the board
  for (MeshVertex& vertex : wall.mesh.vertices) {
    if (vertex.position_W.z() < -0.1f) vertex.position_W.x() += 10.0f;
  }
  cv::Mat green;
  cv::inRange(seenLikeThePainting(wall_, wall), cv::Scalar(0, 200, 0), cv::Scalar(90, 255, 90), green);
  EXPECT_LE(cv::countNonZero(green), 10);  // 200x200 pixels lie behind the board
}

TEST_F(WallTexturing, sameInputGivesTheSameTexture) {
  const Texturing &one = textured_, other = textured(views_);
  ASSERT_EQ(one.textured.pages.size(), 1u);
  EXPECT_EQ(cv::norm(one.textured.pages[0], other.textured.pages[0], cv::NORM_INF), 0.0);
  EXPECT_EQ(one.textured.mesh.triangles, other.textured.mesh.triangles);
}

TEST_F(WallTexturing, whatCannotBeTexturedIsNamed) {
  expectError([&] { textured({}); }, {"no pictures"});
  expectError([&] { textureMesh({}, views_, {}); }, {"no triangles"});
  TexturingView damaged = views_[0];
  damaged.image.resize(damaged.image.size() / 2);
  expectError([&] { textured({damaged}); }, {"a picture for the texture"});
  TexturingView other = views_[0];
  other.camera.width = 320;
  expectError([&] { textured({other}); }, {"640x480", "320x480"});
}

TEST_F(WallTexturing, progressThrowsToGiveUp) {
  std::vector<std::string> steps;
  const auto giveUp = [&](const std::string& step, double) {
    if (steps.empty() || steps.back() != step) steps.push_back(step);
    if (step == "painting") throw Error("enough");
  };
  expectError([&] { textureMesh(wall_.mesh(0.02), views_, quick(), giveUp); }, {"enough"});
  EXPECT_EQ(steps.size(), 6u);
}

}  // namespace
}  // namespace depth_fusion
