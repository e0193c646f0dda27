// The viewer as a user runs it, on a screen in memory.
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "apps/view/ruler.h"
#include "common/io/text_file.h"
#include "depth_fusion/recording/trajectory_file.h"
#include "depth_fusion/surface_mesh/mesh_file.h"
#include "depth_fusion/surface_mesh/ply.h"
#include "depth_fusion/texturing/textured_mesh.h"
#include "support/apps.h"

namespace depth_fusion {
namespace {

// A square of 1 m, 2 m before the origin, red on its left and green on its right half.
TriangleMesh redAndGreen() {
  TriangleMesh mesh;
  for (const float x : {-0.5f, 0.0f, 0.0f, 0.5f}) {
    for (const float y : {-0.5f, 0.5f}) {
      mesh.vertices.push_back({{x, y, 2.0f}, {0.0f, 0.0f, -1.0f}});
      mesh.colors.push_back(mesh.vertices.size() <= 4 ? MeshColor{220, 10, 10} : MeshColor{10, 200, 10});
    }
  }
  mesh.triangles = {{0, 1, 2}, {1, 3, 2}, {4, 5, 6}, {5, 7, 6}};
  return mesh;
}

class View : public testing::Test {
 protected:
  void SetUp() override {
    if (std::system("command -v xvfb-run >/dev/null") != 0) GTEST_SKIP() << "xvfb-run is not installed";
    const AppRun run = view("nothing.ply", {});
    if (run.errors.find("built without PCL") != std::string::npos)
      GTEST_SKIP() << "built without PCL's visualization";
  }

  // What stands before the program's name, the environment, may be a program that runs it.
  AppRun view(const std::string& model, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(),
                     {model, "--screenshot", picture(), "--width", "320", "--height", "240"});
    return runApp("view", arguments, {"xvfb-run", "-a"});
  }
  cv::Mat viewed(const std::string& model, const std::vector<std::string>& arguments = {"--view", "front"}) {
    const AppRun run = view(model, arguments);
    EXPECT_EQ(run.status, 0) << run.errors;
    const cv::Mat image = cv::imread(picture());
    EXPECT_EQ(image.size(), cv::Size(320, 240));
    return image;
  }
  std::string picture() const { return folder_ / "view.png"; }

  TemporaryFolder folder_;
};

void expectRedAndGreen(const cv::Mat& image) {
  const auto left = image.at<cv::Vec3b>(120, 100), right = image.at<cv::Vec3b>(120, 220);
  EXPECT_GT(left[2], left[1] + 100) << left;
  EXPECT_GT(right[1], right[2] + 100) << right;
}

bool isGrey(const cv::Vec3b& bgr) { return std::abs(bgr[2] - bgr[1]) < 40 && bgr[2] > 80; }

TEST_F(View, ShowsMeshesOfEveryFormat) {
  for (const std::string format : {"ply", "obj", "glb", "dae", "stl"}) {
    const std::string path = folder_ / ("square." + format);
    sendMesh(redAndGreen(), *createMeshFile(path));
    const cv::Mat image = viewed(path);
    if (format == "stl") {
      EXPECT_TRUE(isGrey(image.at<cv::Vec3b>(120, 100))) << image.at<cv::Vec3b>(120, 100);
    } else {
      SCOPED_TRACE(format);
      expectRedAndGreen(image);
    }
    EXPECT_LT(image.at<cv::Vec3b>(5, 5)[1], 60) << "the background";
  }
}

// One face in each colour, on two pages.
TEST_F(View, ShowsTextures) {
  const TriangleMesh square = redAndGreen();
  TexturedMesh textured;
  for (const MeshTriangle& t : square.triangles) {
    const auto first = static_cast<uint32_t>(textured.mesh.vertices.size());
    for (const uint32_t vertex : t) textured.mesh.vertices.push_back(square.vertices[vertex]);
    textured.mesh.triangles.push_back({first, first + 1, first + 2});
    textured.places.insert(textured.places.end(), {{1.0f, 1.0f}, {6.0f, 1.0f}, {1.0f, 6.0f}});
  }
  textured.page_ends = {2, 4};
  textured.pages = {cv::Mat(8, 8, CV_8UC3, cv::Scalar(10, 10, 220)),
                    cv::Mat(8, 8, CV_8UC3, cv::Scalar(10, 200, 10))};
  for (const std::string format : {"glb", "obj"}) {
    SCOPED_TRACE(format);
    writeTexturedMesh(folder_ / ("textured." + format), textured);
    expectRedAndGreen(viewed(folder_ / ("textured." + format)));
  }
  textured.mesh.triangles.resize(2);
  textured.page_ends.resize(1);
  textured.pages.resize(1);
  writeTexturedMesh(folder_ / "textured.ply", textured);
  const auto red = viewed(folder_ / "textured.ply").at<cv::Vec3b>(120, 100);
  EXPECT_GT(red[2], red[1] + 100) << red;
}

TEST_F(View, ShowsPoints) {
  std::string points =
      "VERSION .7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH 10000\nHEIGHT 1\n"
      "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 10000\nDATA ascii\n";
  for (int i = 0; i < 10000; ++i)
    points += std::to_string(0.01 * (i % 100) - 0.5) + " " + std::to_string(0.01 * (i / 100) - 0.5) + " 2 " +
              std::to_string(i % 100 < 50 ? 220 << 16 : 200 << 8) + "\n";
  writeText(folder_ / "points.pcd", points);
  expectRedAndGreen(viewed(folder_ / "points.pcd"));
}

TEST_F(View, PaintsAndSides) {
  const std::string path = folder_ / "square.ply";
  writePly(path, redAndGreen());
  EXPECT_TRUE(isGrey(viewed(path, {"--view", "front", "--paint", "shaded"}).at<cv::Vec3b>(120, 100)));
  EXPECT_LT(viewed(path, {"--view", "back"}).at<cv::Vec3b>(120, 100)[1], 60) << "left out from behind";
  const cv::Vec3b behind = viewed(path, {"--view", "back", "--behind"}).at<cv::Vec3b>(120, 220);
  EXPECT_GT(behind[2], behind[1] + 100) << behind;
}

TEST_F(View, ShowsAFolderWithItsWay) {
  writePly(folder_ / "mesh.ply", redAndGreen());
  Trajectory way(2);
  way[0].T_W_D.translation() << -0.4, 0.0, 1.9;
  way[1].stamp_s = 1.0;
  way[1].T_W_D.translation() << 0.4, 0.0, 1.9;
  writeTrajectory(folder_ / "trajectory.txt", way);
  const auto orangePixels = [](const cv::Mat& image) {
    cv::Mat orange;
    cv::inRange(image, cv::Scalar(0, 120, 200), cv::Scalar(80, 200, 255), orange);
    return cv::countNonZero(orange);
  };
  EXPECT_GT(orangePixels(viewed(folder_.path())), 100);
  EXPECT_EQ(orangePixels(viewed(folder_.path(), {"--view", "front", "--no-way"})), 0);
}

TEST_F(View, ShowsTheCertaintyOfMaps) {
  ASSERT_EQ(runApp("simulate", {"--output", folder_ / "room", "--frames", "6"}).status, 0);
  ASSERT_EQ(runApp("reconstruct", {"--input", folder_ / "room", "--output", folder_ / "out", "--voxel-size",
                                   "0.02", "--color", "--no-mesh", "--map", folder_ / "room.map"})
                .status,
            0);
  const cv::Mat colors = viewed(folder_ / "room.map");
  const cv::Mat certainty = viewed(folder_ / "room.map", {"--view", "front", "--paint", "certainty"});
  EXPECT_GT(cv::norm(colors, certainty, cv::NORM_L1) / (3.0 * 320 * 240), 10.0);
  cv::Mat hsv, saturated;
  cv::cvtColor(certainty, hsv, cv::COLOR_BGR2HSV);
  cv::inRange(hsv, cv::Scalar(0, 150, 60), cv::Scalar(180, 255, 255), saturated);
  EXPECT_GT(cv::countNonZero(saturated), 3000);
}

// A piece of the simulated room's wall is as it should be, the same 5 cm before it is red.
TEST_F(View, ShowsErrors) {
  ASSERT_EQ(runApp("simulate", {"--output", folder_ / "wall", "--scene", "wall", "--frames", "1"}).status, 0);
  ASSERT_EQ(runApp("reconstruct",
                   {"--input", folder_ / "wall", "--output", folder_ / "out", "--voxel-size", "0.02"})
                .status,
            0);
  const auto paintedAt = [&](float nearer_m) {
    TriangleMesh mesh = readPly(folder_ / "out/mesh.ply");
    for (MeshVertex& vertex : mesh.vertices) vertex.position_W.z() -= nearer_m;
    writePly(folder_ / "wall.ply", mesh);
    return viewed(folder_ / "wall.ply", {"--view", "front", "--paint", "error", "--truth", folder_ / "wall",
                                         "--full-scale", "0.05"})
        .at<cv::Vec3b>(120, 160);
  };
  const cv::Vec3b right = paintedAt(0.0f), wrong = paintedAt(0.05f);
  EXPECT_GT(right[0], right[2]) << right << " blue";
  EXPECT_LT(right[2], 100) << right << " blue";
  EXPECT_GT(wrong[2], wrong[0] + 30) << wrong << " red";
  EXPECT_NE(view(folder_ / "wall.ply", {"--paint", "error"}).errors.find("--truth"), std::string::npos);
}

// The window is there until it is closed, and the run does not wait for it.
TEST_F(View, TheScanIsShownWhileItGrows) {
  ASSERT_EQ(runApp("simulate", {"--output", folder_ / "room", "--frames", "4"}).status, 0);
  const AppRun run =
      runApp("reconstruct",
             {"--input", folder_ / "room", "--output", folder_ / "out", "--voxel-size", "0.02", "--view"},
             {"xvfb-run", "-a"});
  EXPECT_EQ(run.status, 0) << run.errors;
  EXPECT_GT(readPly(folder_ / "out/mesh.ply").triangles.size(), 1000u);
}

TEST_F(View, SaysWhatIsWrong) {
  writeText(folder_ / "broken.obj", "no mesh\n");
  for (const std::string name : {"missing.ply", "missing.map", "broken.obj", "broken.glb", "broken.pcd"}) {
    const AppRun run = view(folder_ / name, {});
    EXPECT_EQ(run.status, 1) << name;
    EXPECT_NE(run.errors.find(name), std::string::npos) << name << ": " << run.errors;
  }
  const AppRun run = runApp("view", {folder_.path(), "--screenshot", picture()}, {"-u", "DISPLAY"});
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.errors.find("there is no display"), std::string::npos) << run.errors;
}

TEST(Ruler, MeasuresBetweenTwoPicks) {
  Ruler ruler;
  EXPECT_EQ(ruler.text(), "");
  ruler.pick({1.0, 2.0, 3.0});
  EXPECT_NE(ruler.text().find("1.000, 2.000, 3.000"), std::string::npos);
  ruler.pick({1.0, 2.3, 3.4});
  EXPECT_EQ(ruler.text(), "0.500 m");
  ruler.pick({0.0, 0.0, 0.0});
  EXPECT_EQ(ruler.points_W().size(), 1u);
  ruler.clear();
  EXPECT_TRUE(ruler.points_W().empty());
}

}  // namespace
}  // namespace depth_fusion
