// Surfaces as users take them out: with pictures on them, in other formats, and objects off their ground.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <map>

#include "depth_fusion/surface_mesh/ply.h"
#include "support/apps.h"

namespace depth_fusion {
namespace {

void expectRefused(const AppRun& run, const std::vector<std::string>& words) {
  EXPECT_EQ(run.status, 1) << run.output;
  for (const std::string& word : words)
    EXPECT_NE(run.errors.find(word), std::string::npos) << "'" << word << "' is not in: " << run.errors;
}

// The number behind the word.
double numberAfter(const std::string& text, const std::string& word) {
  const size_t place = text.find(word);
  EXPECT_NE(place, std::string::npos) << "'" << word << "' is not in: " << text;
  return place == std::string::npos ? 0.0 : std::stod(text.substr(place + word.size()));
}

// Simulates and reconstructs once for all tests.
class Export : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>();
    ASSERT_EQ(runApp("simulate", {"--output", in("room"), "--frames", "8"}).status, 0);
    const AppRun run =
        runApp("reconstruct", {"--input", in("room"), "--output", in("out"), "--voxel-size", "0.02",
                               "--max-range", "3", "--color", "--map", in("room.map")});
    ASSERT_EQ(run.status, 0) << run.errors;
  }
  static void TearDownTestSuite() { folder_.reset(); }
  static std::string in(const std::string& name) { return *folder_ / name; }

  inline static std::unique_ptr<TemporaryFolder> folder_;
};

TEST_F(Export, picturesOfAMapsKeyframesAreItsTexture) {
  for (const std::string format : {"glb", "obj"}) {
    const std::string path = in("textured." + format);
    const AppRun run = runApp("texture", {in("room.map"), "--output", path});
    ASSERT_EQ(run.status, 0) << run.errors;
    EXPECT_GT(numberAfter(run.output, "faces, "), 30.0) << "percent of the surface";
    EXPECT_NE(run.errors.find("painting"), std::string::npos) << "the progress: " << run.errors;
    EXPECT_GT(std::filesystem::file_size(path), 100000u);
  }
  EXPECT_EQ(fileBytes(in("textured.glb")).substr(0, 4), "glTF");
  EXPECT_TRUE(std::filesystem::exists(in("textured.mtl")));
  EXPECT_TRUE(std::filesystem::exists(in("textured_0.png")));
}

TEST_F(Export, framesOfARecordingAreATextureThatPredictsOthers) {
  const AppRun run = runApp("texture", {"--input", in("room"), "--reconstruction", in("out"), "--output",
                                        in("frames.glb"), "--keep-back", "4", "--max-hole", "0.1"});
  ASSERT_EQ(run.status, 0) << run.errors;
  const double texture_db = numberAfter(run.output, "predicted to ");
  EXPECT_GT(texture_db, numberAfter(run.output, "by the texture, ") + 3.0);
  EXPECT_NE(run.output.find("holes closed"), std::string::npos) << run.output;
}

TEST_F(Export, whatHasNoPicturesIsNoTexture) {
  ASSERT_EQ(runApp("reconstruct", {"--input", in("room"), "--output", in("plain"), "--voxel-size", "0.02",
                                   "--max-frames", "2", "--no-mesh", "--map", in("plain.map")})
                .status,
            0);
  expectRefused(runApp("texture", {in("plain.map"), "--output", in("plain.glb")}),
                {"plain.map", "none of its", "has a picture", "--color"});
  EXPECT_FALSE(std::filesystem::exists(in("plain.glb")));
  expectRefused(runApp("texture", {in("room.map"), "--output", in("room.stl")}), {"room.stl", ".glb"});
  expectRefused(runApp("texture", {in("room.map"), "--output", in("no/such/room.glb")}), {"no/such"});
  expectRefused(runApp("texture", {in("missing.map"), "--output", in("room.glb")}), {"missing.map"});
  expectRefused(runApp("texture", {"--output", in("room.glb")}), {"a map or --input"});
}

TEST_F(Export, aMapIsWrittenAsItWasReconstructed) {
  for (const std::string format : {"ply", "dae"}) {
    const AppRun run = runApp("export_mesh", {in("room.map"), "--output", in("mesh." + format)});
    EXPECT_EQ(run.status, 0) << run.errors;
    EXPECT_GT(std::filesystem::file_size(in("mesh." + format)), 10000u) << format;
  }
  EXPECT_EQ(fileBytes(in("mesh.ply")), fileBytes(in("out/mesh.ply")));
  expectRefused(runApp("export_mesh", {in("room.map"), "--output", in("mesh.fbx")}),
                {"fbx", "ply, obj, stl"});
  expectRefused(runApp("export_mesh", {in("room.map"), "--output", in("no/such/mesh.ply")}), {"no/such"});
  expectRefused(runApp("export_mesh", {in("missing.ply"), "--output", in("mesh.obj")}), {"missing.ply"});
}

constexpr float kRadius_m = 0.05f;

// A grid in polar coordinates: a ball that stands on the ground z = 0, open at its foot, with the ground
// about it from there on, 0.4 m wide, and a post at its edge.
TriangleMesh ballOnTheGround() {
  constexpr int kAround = 96, kUp = 40;
  TriangleMesh mesh;
  const auto addRing = [&](float radius_m, float z_m, const MeshColor& color) {
    for (int i = 0; i < kAround; ++i) {
      const float angle = 6.2831853f * static_cast<float>(i) / kAround;
      mesh.vertices.push_back(
          {{radius_m * std::cos(angle), radius_m * std::sin(angle), z_m}, Eigen::Vector3f::UnitZ()});
      mesh.colors.push_back(color);
    }
  };
  for (int i = 1; i <= kUp; ++i) {
    const float angle = 2.6f * static_cast<float>(i) / kUp;  // from the top down
    addRing(kRadius_m * std::sin(angle), kRadius_m * (1.0f + std::cos(angle)), {200, 0, 0});
    for (size_t k = mesh.vertices.size() - kAround; k < mesh.vertices.size(); ++k)
      mesh.vertices[k].normal_W =
          (mesh.vertices[k].position_W - Eigen::Vector3f(0.0f, 0.0f, kRadius_m)).normalized();
  }
  for (int i = 0; i < 40; ++i) addRing(0.03f + 0.005f * static_cast<float>(i), 0.0f, {0, 200, 0});
  addRing(0.23f, 0.1f, {0, 0, 200});
  const auto rings = static_cast<uint32_t>(mesh.vertices.size() / kAround);
  for (uint32_t ring = 0; ring + 1 < rings; ++ring) {
    for (uint32_t i = 0; i < kAround; ++i) {
      const uint32_t a = ring * kAround + i, b = ring * kAround + (i + 1) % kAround;
      mesh.triangles.push_back({a, a + kAround, b});
      mesh.triangles.push_back({b, a + kAround, b + kAround});
    }
  }
  return mesh;
}

TEST(ObjectExport, anObjectComesOffItsGroundClosedAndTrueToScale) {
  const TemporaryFolder folder;
  writePly(folder / "scan.ply", ballOnTheGround());
  const AppRun run =
      runApp("export_mesh", {folder / "scan.ply", "--output", folder / "ball.ply",
                             "--crop=-0.15,-0.15,-0.1,0.15,0.15,0.2", "--remove-ground", "0.004", "--close"});
  if (run.errors.find("built without PCL") != std::string::npos) GTEST_SKIP() << run.errors;
  ASSERT_EQ(run.status, 0) << run.errors;
  for (const std::string word : {"cropped", "taken off the ground", "closed"})
    EXPECT_NE(run.output.find(word), std::string::npos) << run.output;
  const TriangleMesh ball = readPly(folder / "ball.ply");
  std::map<std::pair<uint32_t, uint32_t>, int> edges;
  double volume_m3 = 0.0;
  for (const MeshTriangle& t : ball.triangles) {
    for (int i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
    const auto corner = [&](int i) { return ball.vertices[t[i]].position_W.cast<double>(); };
    volume_m3 += corner(0).cross(corner(1)).dot(corner(2)) / 6.0;
  }
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, 1) << edge.first << " " << edge.second;
    ASSERT_EQ(edges.count({edge.second, edge.first}), 1u) << edge.first << " " << edge.second;
  }
  EXPECT_NEAR(volume_m3, 4.18879 * std::pow(kRadius_m, 3), 0.1 * 4.18879 * std::pow(kRadius_m, 3));
  for (size_t i = 0; i < ball.vertices.size(); ++i) {
    const Eigen::Vector3f p_B = ball.vertices[i].position_W - Eigen::Vector3f(0.0f, 0.0f, kRadius_m);
    if (p_B.z() > 0.0f) {
      EXPECT_NEAR(p_B.norm(), kRadius_m, 0.0015f);
    }
    EXPECT_EQ(ball.colors[i], (MeshColor{200, 0, 0}));
  }
}

TEST(ObjectExport, whatLeavesNothingIsSaid) {
  const TemporaryFolder folder;
  writePly(folder / "scan.ply", ballOnTheGround());
  expectRefused(
      runApp("export_mesh", {folder / "scan.ply", "--output", folder / "ball.ply", "--crop", "1,1,1,2,2,2"}),
      {"nothing", "cropped"});
  expectRefused(
      runApp("export_mesh", {folder / "scan.ply", "--output", folder / "ball.ply", "--crop", "1,1,1,0,0,0"}),
      {"box", "empty"});
  EXPECT_FALSE(std::filesystem::exists(folder / "ball.ply"));
}

}  // namespace
}  // namespace depth_fusion
