// The action export_mesh: to files and messages, with progress, and cancelled.
#include <actionlib/client/simple_action_client.h>
#include <depth_fusion/ExportMeshAction.h>
#include <stdlib.h>

#include <filesystem>

#include "depth_fusion/surface_mesh/ply.h"
#include "support/nodelet_graph.h"
#include "support/offered_map.h"
#include "support/temporary_folder.h"

namespace depth_fusion {
namespace {

using State = actionlib::SimpleClientGoalState;

class MeshAction : public testing::Test {
 protected:
  MeshAction() : graph_("mesh_action"), client_(graph_.handle(), "surface_mesh/export_mesh", false) {
    setenv("ROS_HOME", ros_home_.path().c_str(), 1);
  }

  void load() {
    ASSERT_TRUE(graph_.load("surface_mesh"));
    ASSERT_TRUE(client_.waitForServer(ros::Duration(kPatience_s)));
  }
  static ExportMeshGoal goalOf(const std::string& path) {
    ExportMeshGoal goal;
    goal.path = path;
    return goal;
  }
  ExportMeshResult resultOf(const ExportMeshGoal& goal, State::StateEnum expected) {
    client_.sendGoal(goal);
    return awaited(expected);
  }
  ExportMeshResult awaited(State::StateEnum expected) {
    EXPECT_TRUE(client_.waitForResult(ros::Duration(kPatience_s)));
    EXPECT_EQ(client_.getState().toString(), State(expected).toString()) << client_.getState().getText();
    return client_.getResult() == nullptr ? ExportMeshResult() : *client_.getResult();
  }

  TemporaryFolder ros_home_;
  NodeletGraph graph_;
  actionlib::SimpleActionClient<ExportMeshAction> client_;
};

TEST_F(MeshAction, WritesAFileAndTellsHowFarItIs) {
  OfferedMap map(graph_.resolve("tsdf_fusion"));
  map.show(ball({0.0, 0.0, 0.0}, 0.08));
  load();
  const Listener<ExportMeshActionFeedback> feedback(graph_.handle(), "surface_mesh/export_mesh/feedback");
  ASSERT_TRUE(eventually([&] { return feedback.connected(); }));
  const ExportMeshResult result = resultOf(goalOf("ball.ply"), State::SUCCEEDED);
  EXPECT_EQ(result.message, ros_home_ / "ball.ply");
  const TriangleMesh written = readPly(ros_home_ / "ball.ply");
  EXPECT_EQ(written.triangles, map.mesh().triangles);
  EXPECT_EQ(result.vertices, written.vertices.size());
  EXPECT_EQ(result.triangles, written.triangles.size());
  EXPECT_EQ(result.bytes, std::filesystem::file_size(ros_home_ / "ball.ply"));
  EXPECT_TRUE(result.mesh.vertices.empty());
  ASSERT_TRUE(feedback.awaitCount(2));  // the blocks are counted, then turned into triangles
  float last = 0.0f;
  for (const auto& message : feedback.all()) {
    EXPECT_GE(message->feedback.done, last);
    last = message->feedback.done;
  }
  EXPECT_EQ(feedback.all().front()->feedback.done, 0.0f);
  EXPECT_GE(last, 0.5f);
  EXPECT_LE(last, 1.0f);
}

TEST_F(MeshAction, GivesTheMeshAsAMessageWithoutAPath) {
  OfferedMap map(graph_.resolve("tsdf_fusion"), true);
  map.show(ball({0.0, 0.0, 0.0}, 0.08));
  load();
  ExportMeshGoal goal;
  goal.color = true;
  const ExportMeshResult result = resultOf(goal, State::SUCCEEDED);
  const TriangleMesh expected = map.mesh();
  const MeshGeometry& mesh = result.mesh;
  EXPECT_EQ(mesh.header.frame_id, "map");
  ASSERT_EQ(mesh.vertices.size(), 3 * expected.vertices.size());
  ASSERT_EQ(mesh.normals.size(), 3 * expected.vertices.size());
  ASSERT_EQ(mesh.colors.size(), 3 * expected.vertices.size());
  ASSERT_EQ(mesh.triangles.size(), 3 * expected.triangles.size());
  for (size_t i = 0; i < mesh.vertices.size(); ++i) {
    ASSERT_EQ(mesh.vertices[i], expected.vertices[i / 3].position_W[static_cast<int>(i % 3)]);
    ASSERT_EQ(mesh.normals[i], expected.vertices[i / 3].normal_W[static_cast<int>(i % 3)]);
    ASSERT_EQ(mesh.colors[i], expected.colors[i / 3][i % 3]);
  }
  for (size_t i = 0; i < mesh.triangles.size(); ++i)
    ASSERT_EQ(mesh.triangles[i], expected.triangles[i / 3][i % 3]);
  EXPECT_EQ(result.vertices, expected.vertices.size());
  EXPECT_EQ(result.bytes, 0u);
  EXPECT_TRUE(std::filesystem::is_empty(ros_home_.path()));
}

// The map is held while the goal is cancelled, so that the export cannot have ended before.
TEST_F(MeshAction, IsCancelled) {
  OfferedMap map(graph_.resolve("tsdf_fusion"));
  map.show(ball({0.0, 0.0, 0.0}, 0.08));
  load();
  const Listener<actionlib_msgs::GoalStatusArray> states(graph_.handle(), "surface_mesh/export_mesh/status");
  const auto is_in_state = [&](uint8_t state) {
    return states.await([&](const actionlib_msgs::GoalStatusArray& array) {
      return !array.status_list.empty() && array.status_list.back().status == state;
    }) != nullptr;
  };
  map.whileHeld([&] {
    client_.sendGoal(goalOf("ball.ply"));
    ASSERT_TRUE(is_in_state(actionlib_msgs::GoalStatus::ACTIVE));
    client_.cancelGoal();
    ASSERT_TRUE(is_in_state(actionlib_msgs::GoalStatus::PREEMPTING));
  });
  const ExportMeshResult result = awaited(State::PREEMPTED);
  EXPECT_NE(result.message.find("cancelled"), std::string::npos) << result.message;
  EXPECT_TRUE(std::filesystem::is_empty(ros_home_.path()));
  EXPECT_EQ(resultOf(goalOf("ball.ply"), State::SUCCEEDED).message, ros_home_ / "ball.ply");
}

TEST_F(MeshAction, SaysWhatItCannotDo) {
  load();
  const ExportMeshResult without_map = resultOf(goalOf("ball.ply"), State::ABORTED);
  EXPECT_NE(without_map.message.find("no map"), std::string::npos) << without_map.message;
  OfferedMap map(graph_.resolve("tsdf_fusion"));
  const ExportMeshResult empty = resultOf(ExportMeshGoal(), State::ABORTED);
  EXPECT_NE(empty.message.find("no surface yet"), std::string::npos) << empty.message;
  EXPECT_EQ(client_.getState().getText(), empty.message);
}

}  // namespace
}  // namespace depth_fusion
