// The service export_mesh.
#include "ros/output/mesh_export.h"

#include <depth_fusion/ExportMesh.h>
#include <stdlib.h>

#include <filesystem>
#include <thread>

#include "depth_fusion/surface_mesh/ply.h"
#include "depth_fusion/surface_mesh/simplification.h"
#include "support/file_bytes.h"
#include "support/nodelet_graph.h"
#include "support/offered_map.h"
#include "support/temporary_folder.h"

namespace depth_fusion {
namespace {

class MeshExport : public testing::Test {
 protected:
  MeshExport() : graph_("mesh_export") { setenv("ROS_HOME", ros_home_.path().c_str(), 1); }

  void load() {
    ASSERT_TRUE(graph_.load("surface_mesh"));
    client_ = graph_.handle().serviceClient<ExportMesh>("surface_mesh/export_mesh");
    ASSERT_TRUE(client_.waitForExistence(ros::Duration(10.0)));
  }

  ExportMesh::Response call(const std::string& path, double simplification = 0.0, bool color = false,
                            const std::string& format = "") {
    ExportMesh service;
    service.request.path = path;
    service.request.format = format;
    service.request.color = color;
    service.request.simplification = simplification;
    EXPECT_TRUE(client_.call(service));
    return service.response;
  }
  ExportMesh::Response callForTexture(const std::string& path) {
    ExportMesh service;
    service.request.path = path;
    service.request.texture = true;
    EXPECT_TRUE(client_.call(service));
    return service.response;
  }
  void expectRefusal(const ExportMesh::Response& response, const std::vector<std::string>& words) {
    EXPECT_FALSE(response.success);
    EXPECT_EQ(response.message.find('\n'), std::string::npos) << response.message;
    for (const std::string& word : words)
      EXPECT_NE(response.message.find(word), std::string::npos)
          << "'" << word << "' is not in: " << response.message;
    EXPECT_TRUE(std::filesystem::is_empty(ros_home_.path()));
  }

  TemporaryFolder ros_home_;
  NodeletGraph graph_;
  ros::ServiceClient client_;
};

TEST_F(MeshExport, writesTheSurfaceAndSaysWhatItWrote) {
  OfferedMap map(graph_.resolve("tsdf_fusion"));
  map.show(ball({0.0, 0.0, 0.0}, 0.08));
  load();
  const ExportMesh::Response response = call("ball.ply");
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_EQ(response.message, ros_home_ / "ball.ply");
  const TriangleMesh written = readPly(response.message);
  EXPECT_EQ(written.triangles, map.mesh().triangles);
  EXPECT_EQ(response.vertices, written.vertices.size());
  EXPECT_EQ(response.triangles, written.triangles.size());
  EXPECT_EQ(response.bytes, std::filesystem::file_size(response.message));
}

TEST_F(MeshExport, takesAbsolutePathsFormatsAndEndings) {
  OfferedMap map(graph_.resolve("tsdf_fusion"));
  map.show(ball({0.0, 0.0, 0.0}, 0.08));
  load();
  const TemporaryFolder folder;
  for (const char* name : {"mesh.obj", "mesh.stl", "mesh.ply"}) {
    const ExportMesh::Response response = call(folder / name);
    EXPECT_TRUE(response.success) << response.message;
    EXPECT_EQ(response.message, folder / name);
    EXPECT_EQ(response.triangles, map.mesh().triangles.size());
  }
  const ExportMesh::Response response = call(folder / "mesh", 1.0, false, "ply");
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_EQ(readPly(folder / "mesh").triangles.size(), map.mesh().triangles.size());
}

TEST_F(MeshExport, simplifiesOnRequest) {
  OfferedMap map(graph_.resolve("tsdf_fusion"));
  map.show(ball({0.0, 0.0, 0.0}, 0.08));
  load();
  if (!canSimplify()) return expectRefusal(call("ball.ply", 0.1), {"libmeshoptimizer-dev"});
  const ExportMesh::Response response = call("ball.ply", 0.1);
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_LE(response.triangles, map.mesh().triangles.size() / 10);
  EXPECT_EQ(readPly(response.message).triangles.size(), response.triangles);
}

TEST_F(MeshExport, givesColorsOnRequest) {
  OfferedMap map(graph_.resolve("tsdf_fusion"), true);
  map.show(ball({0.0, 0.0, 0.0}, 0.08));
  load();
  EXPECT_TRUE(readPly(call("plain.ply").message).colors.empty());
  EXPECT_EQ(readPly(call("colored.ply", 0.0, true).message).colors, map.mesh().colors);
}

TEST_F(MeshExport, saysThatTheMapHasNoColors) {
  OfferedMap map(graph_.resolve("tsdf_fusion"));
  map.show(ball({0.0, 0.0, 0.0}, 0.08));
  load();
  const ExportMesh::Response response = call("ball.ply", 0.0, true);
  EXPECT_TRUE(response.success) << response.message;
  EXPECT_EQ(response.message.find(ros_home_ / "ball.ply"), 0u) << response.message;
  EXPECT_NE(response.message.find("without colour"), std::string::npos) << response.message;
  EXPECT_TRUE(readPly(ros_home_ / "ball.ply").colors.empty());
}

TEST_F(MeshExport, refusesWhatItCannotDo) {
  OfferedMap map(graph_.resolve("tsdf_fusion"));
  load();
  expectRefusal(call("mesh.ply"), {"no surface yet"});
  expectRefusal(call("mesh.ply", 0.0, true), {"no surface yet", "no colour", "color:=true"});
  map.show(ball({0.0, 0.0, 0.0}, 0.08));
  expectRefusal(call(""), {"path is empty"});
  expectRefusal(call("no/such/mesh.ply"), {ros_home_ / "no/such", "does not exist"});
  expectRefusal(call(ros_home_.path()), {ros_home_.path(), "is a folder"});
  expectRefusal(call("mesh.fbx"), {"fbx", "ply, obj, stl"});
  expectRefusal(call("mesh.ply", 0.0, false, "las"), {"las", "ply, obj, stl"});
  expectRefusal(call("mesh.ply", 1.5), {"simplification", "1.5"});
  expectRefusal(call("mesh.ply", -0.1), {"simplification", "-0.1"});
  expectRefusal(call("/dev/full"), {"/dev/full"});
  expectRefusal(callForTexture("mesh.glb"), {"no pictures", "color:=true"});
}

TEST_F(MeshExport, refusesTexturesThatItCannotMake) {
  OfferedMap map(graph_.resolve("tsdf_fusion"), true);
  load();
  map.show(ball({0.0, 0.0, 0.0}, 0.08));
  expectRefusal(callForTexture("mesh.glb"), {"none of the map's 0 keyframes"});
  expectRefusal(callForTexture("mesh.stl"), {"mesh.stl", ".obj, .glb or .ply"});
}

TEST_F(MeshExport, refusesWithoutAMap) {
  load();
  expectRefusal(call("mesh.ply"), {"no map", graph_.resolve("tsdf_fusion")});
}

// Frames come while the mesh is exported: both go on at the same time, all frames are fused, and the file is
// whole.
TEST_F(MeshExport, answersWhileDataFlows) {
  constexpr int kFrames = 40;
  for (const char* nodelet : {"texture_odometry", "icp_tracking", "tsdf_fusion"})
    graph_.handle().setParam(std::string(nodelet) + "/queue_size", kFrames);
  graph_.handle().setParam("icp_tracking/level_start", false);
  Listener<MapStatus> map_status(graph_.handle(), "tsdf_fusion/status");
  graph_.loadTracking();
  load();
  FakeCamera camera(graph_.handle());
  ASSERT_TRUE(camera.awaitSubscribers());
  size_t fused_meanwhile = 0;
  std::thread user([&] {
    ASSERT_TRUE(map_status.awaitCount(5));
    do {
      const size_t before = map_status.count();
      const ExportMesh::Response response = call("room.ply");
      fused_meanwhile += map_status.count() - before;
      ASSERT_TRUE(response.success) << response.message;
      EXPECT_GT(response.triangles, 10000u);
      EXPECT_EQ(readPly(response.message).triangles.size(), response.triangles);
    } while (map_status.count() < kFrames);
  });
  for (const RgbdFrame& frame : simulatedFrames(smallRoom(kFrames))) {
    camera.publish(frame);
    ros::WallDuration(1.0 / 15.0).sleep();
  }
  EXPECT_TRUE(map_status.awaitCount(kFrames));
  user.join();
  EXPECT_GT(fused_meanwhile, 0u);
  for (const auto& status : map_status.all()) EXPECT_TRUE(status->fused) << status->reason;
}

// The pictures are those of the keyframes of a map that is being made.
TEST_F(MeshExport, putsTheKeyframesPicturesOnTheSurface) {
  graph_.handle().setParam("map/color", true);
  graph_.handle().setParam("map/voxel_size_m", 0.03);
  graph_.handle().setParam("texturing/alignment_rounds", 2);
  Listener<MapStatus> map_status(graph_.handle(), "tsdf_fusion/status");
  graph_.loadTracking();
  load();
  FakeCamera camera(graph_.handle());
  ASSERT_TRUE(camera.awaitSubscribers());
  for (const RgbdFrame& frame : simulatedFrames(smallRoom(3))) {
    camera.publish(frame);
    ASSERT_NE(map_status.awaitStamp(camera.headerOf(frame).stamp), nullptr);
  }
  ExportMesh::Response response = callForTexture("room.glb");
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_EQ(response.message.find(ros_home_ / "room.glb"), 0u) << response.message;
  EXPECT_NE(response.message.find("pictures show"), std::string::npos) << response.message;
  EXPECT_GT(response.triangles, 1000u);
  EXPECT_EQ(response.bytes, std::filesystem::file_size(ros_home_ / "room.glb"));
  EXPECT_NE(fileBytes(ros_home_ / "room.glb").find("image/png"), std::string::npos);
}

TEST(PathsOfMeshes, MayHaveTheHomeVariablesAndBlanks) {
  setenv("DEPTH_FUSION_FOLDER", "/data", 1);
  EXPECT_EQ(absolutePath("$DEPTH_FUSION_FOLDER/my room's mesh (1).ply"), "/data/my room's mesh (1).ply");
  setenv("DEPTH_FUSION_FOLDER", "/my  data/~ *[a]'s", 1);
  EXPECT_EQ(absolutePath("${DEPTH_FUSION_FOLDER}/a b.ply"), "/my  data/~ *[a]'s/a b.ply");
  EXPECT_EQ(absolutePath("/$DEPTH_FUSION_FOLDER$DEPTH_FUSION_FOLDER"),
            "/my  data/~ *[a]'s/my  data/~ *[a]'s");
  EXPECT_EQ(absolutePath("/5$ \\ \"a\" `b` $(c).ply"), "/5$ \\ \"a\" `b` $(c).ply");
  EXPECT_EQ(absolutePath("/~ mine.ply"), "/~ mine.ply");
  EXPECT_EQ(absolutePath("~/room.ply"), std::string(std::getenv("HOME")) + "/room.ply");
  EXPECT_THROW(absolutePath("$DEPTH_FUSION_NONE_SUCH/room.ply"), Error);
}

}  // namespace
}  // namespace depth_fusion
