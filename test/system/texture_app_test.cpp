// A map and a recording become textured meshes and meshes of other formats, as a user does it.
#include <gtest/gtest.h>

#include <filesystem>

#include "depth_fusion/surface_mesh/ply.h"
#include "support/apps.h"

namespace depth_fusion {
namespace {

// Simulates and reconstructs in colour once for all tests.
class TextureApp : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>();
    ASSERT_EQ(runApp("simulate", {"--output", file("room"), "--frames", "20"}).status, 0);
    const AppRun run = runApp("reconstruct", {"--input", file("room"), "--output", file("out"),
                                              "--voxel-size", "0.02", "--color", "--map", file("room.map")});
    ASSERT_EQ(run.status, 0) << run.errors;
  }
  static void TearDownTestSuite() { folder_.reset(); }
  static std::string file(const std::string& name) { return *folder_ / name; }

  static void expectSaid(const AppRun& run, const std::vector<std::string>& words) {
    for (const std::string& word : words)
      EXPECT_NE(run.output.find(word), std::string::npos) << "'" << word << "' is not in: " << run.output;
  }
  static void expectFailure(const AppRun& run, const std::string& word) {
    EXPECT_EQ(run.status, 1);
    EXPECT_NE(run.errors.find(word), std::string::npos) << run.errors;
  }

  inline static std::unique_ptr<TemporaryFolder> folder_;
};

TEST_F(TextureApp, mapIsTexturedByItsKeyframes) {
  const AppRun run = runApp("texture", {file("room.map"), "--output", file("map.obj"), "--share", "0.5"});
  ASSERT_EQ(run.status, 0) << run.errors;
  expectSaid(run, {"pictures:", "coverage:", "seams:", "atlas:", "triangles kept", "map.obj"});
  for (const std::string name : {"map.obj", "map.mtl", "map_0.png"})
    EXPECT_GT(std::filesystem::file_size(file(name)), 100u);
}

TEST_F(TextureApp, recordingIsTexturedAndItsPicturesArePredicted) {
  const AppRun run = runApp("texture", {"--input", file("room"), "--reconstruction", file("out"), "--output",
                                        file("room.glb"), "--keep-back", "5"});
  ASSERT_EQ(run.status, 0) << run.errors;
  expectSaid(run, {"kept back:  4 pictures", "by the texture", "room.glb"});
  const size_t at = run.output.find("predicted to ");
  double by_texture_db = 0.0, by_vertices_db = 0.0;
  ASSERT_EQ(std::sscanf(run.output.c_str() + at, "predicted to %lf dB (PSNR, mean) by the texture, %lf",
                        &by_texture_db, &by_vertices_db),
            2);
  EXPECT_GT(by_texture_db, by_vertices_db + 3.0);
}

TEST_F(TextureApp, whatIsMissingIsSaid) {
  expectFailure(runApp("texture", {file("room.map"), "--output", file("map.fbx")}), ".obj or .glb");
  expectFailure(runApp("texture", {"--input", file("room"), "--output", file("x.glb")}), "--reconstruction");
  expectFailure(runApp("texture", {"--output", file("x.glb")}), "a map or --input");
  const AppRun run = runApp("reconstruct", {"--input", file("room"), "--output", file("grey"), "--voxel-size",
                                            "0.02", "--max-frames", "3", "--map", file("grey.map")});
  ASSERT_EQ(run.status, 0) << run.errors;
  expectFailure(runApp("texture", {file("grey.map"), "--output", file("x.glb")}), "--color");
  EXPECT_FALSE(std::filesystem::exists(file("x.glb")));
}

TEST_F(TextureApp, mapAndMeshAreExported) {
  const AppRun map = runApp("export_mesh", {file("room.map"), "--output", file("room.ply")});
  ASSERT_EQ(map.status, 0) << map.errors;
  EXPECT_EQ(fileBytes(file("room.ply")), fileBytes(file("out/mesh.ply")));
  for (const std::string format : {"obj", "stl", "glb", "dae", "pcd"}) {
    const AppRun run = runApp("export_mesh", {file("room.ply"), "--output", file("all." + format)});
    EXPECT_EQ(run.status, 0) << run.errors;
    EXPECT_GT(std::filesystem::file_size(file("all." + format)), 1000u);
  }
  const AppRun finished =
      runApp("export_mesh", {file("room.ply"), "--output", file("small.ply"), "--min-island", "0.5",
                             "--max-hole", "0.2", "--triangles", "2000"});
  ASSERT_EQ(finished.status, 0) << finished.errors;
  expectSaid(finished, {"islands removed", "holes closed", "triangles kept"});
  EXPECT_LE(readPly(file("small.ply")).triangles.size(), 2000u);
  expectFailure(runApp("export_mesh", {file("room.ply"), "--output", file("x.fbx")}),
                "ply, obj, stl, glb, dae, pcd");
  expectFailure(runApp("export_mesh", {file("no.ply"), "--output", file("x.glb")}), "no.ply");
  EXPECT_FALSE(std::filesystem::exists(file("x.glb")));
}

}  // namespace
}  // namespace depth_fusion
