// Maps of a live graph that are made anew from their keyframes, by a service and where loops are closed.
#include <depth_fusion/ClearRegion.h>
#include <depth_fusion/LoopStatus.h>
#include <depth_fusion/RefineMap.h>
#include <nav_msgs/Path.h>

#include "depth_fusion/submaps/map_check.h"
#include "ros/in_process/shared_map.h"
#include "support/live_graph.h"
#include "support/temporary_folder.h"

namespace depth_fusion {
namespace {

class RefinedMap : public LiveGraph {
 protected:
  // Loops are sought from the first frame on.
  void loadSeeking() {
    loadTracking();
    ASSERT_TRUE(eventually([&] {
      const std::shared_ptr<SharedMap> map = findMap(graph_.resolve("tsdf_fusion"));
      const uint32_t generation = map->locked([](FusedMap& fused) { return fused.map().generation(); });
      return map->loopsOf(generation).closing != nullptr;
    }));
  }
  RefineMap::Response refine(const std::string& path = "", float voxel_size_m = 0.0f) {
    RefineMap service;
    service.request.path = path;
    service.request.voxel_size_m = voxel_size_m;
    EXPECT_TRUE(call<RefineMap>("tsdf_fusion/refine_map", service.request, service.response));
    return service.response;
  }
  // The frame is found where it is, in its place among the others.
  void expectTracked(const RgbdFrame& frame, const RgbdFrame& first) {
    const auto status = track(frame);
    ASSERT_NE(status, nullptr);
    EXPECT_EQ(status->state, TrackerStatus::TRACKING) << status->reason;
    const auto begin = poses_.awaitStamp(camera_.headerOf(first).stamp);
    const auto pose = poses_.awaitStamp(camera_.headerOf(frame).stamp);
    ASSERT_TRUE(begin != nullptr && pose != nullptr);
    expectPose(fromMessage(begin->pose.pose).inverse() * fromMessage(pose->pose.pose),
               first.T_W_D->inverse() * *frame.T_W_D, 0.02);
  }

  const std::vector<RgbdFrame> frames_ = simulatedFrames(smallRoom(12));
};

TEST_F(RefinedMap, TakesItsOwnPlaceAndTrackingGoesOn) {
  loadSeeking();
  fuseAll({frames_.begin(), frames_.end() - 2});
  const MapStatus before = *map_status_.all().back();
  const RefineMap::Response refined = refine();
  ASSERT_TRUE(refined.success) << refined.message;
  EXPECT_GT(refined.keyframes, 0u);
  EXPECT_LT(refined.moved_m, 1e-6) << "no loop was closed";
  const auto after =
      map_status_.await([&](const MapStatus& status) { return status.generation != before.generation; });
  ASSERT_NE(after, nullptr);
  EXPECT_GT(after->blocks, before.blocks / 2);
  expectTracked(frames_[frames_.size() - 2], frames_.front());
  expectTracked(frames_.back(), frames_.front());
}

TEST_F(RefinedMap, IsSavedFinerThanItWasScanned) {
  graph_.handle().setParam("map/voxel_size_m", 0.02);
  loadSeeking();
  fuseAll({frames_.begin(), frames_.end() - 2});
  const MapStatus before = *map_status_.all().back();
  const TemporaryFolder folder;
  EXPECT_NE(refine("", 0.01f).message.find("path"), std::string::npos);
  EXPECT_NE(refine(folder / "fine.map", 99.0f).message.find("voxel_size_m"), std::string::npos);
  const RefineMap::Response refined = refine(folder / "fine.map", 0.01f);
  ASSERT_TRUE(refined.success) << refined.message;
  const auto stored = openDatabase(folder / "fine.map", DatabaseAccess::kRead);
  EXPECT_EQ(checkMap(*stored).problems.size(), 0u);
  EXPECT_GT(checkMap(*stored).blocks.at("tsdf"), 2 * before.blocks);
  expectTracked(frames_.back(), frames_.front());
  EXPECT_EQ(map_status_.all().back()->generation, before.generation) << "the live map stays";
}

// What was cleared does not come back.
TEST_F(RefinedMap, KeepsInMindWhatWasCleared) {
  loadSeeking();
  fuseAll({frames_.begin(), frames_.end() - 2});
  ClearRegion region;
  region.request.header.frame_id = "map";
  region.request.pose.orientation.w = 1.0;
  region.request.radius = 100.0;
  ASSERT_TRUE(call<ClearRegion>("tsdf_fusion/clear_region", region.request, region.response));
  ASSERT_GT(region.response.blocks, 0u);
  const RefineMap::Response refined = refine();
  EXPECT_FALSE(refined.success);
  EXPECT_NE(refined.message.find("no keyframe shows anything"), std::string::npos) << refined.message;
}

// A way, and back: the place where it began is seen again, and however little that moves, the map follows.
TEST_F(RefinedMap, MovesWhereLoopsAreClosed) {
  graph_.handle().setParam("loops/min_way_m", 0.5);
  graph_.handle().setParam("loops/agreeing_loops", 2);
  graph_.handle().setParam("loops/least_move_m", 0.0);
  Listener<LoopStatus> loops(graph_.handle(), "tsdf_fusion/loops");
  Listener<nav_msgs::Path> paths(graph_.handle(), "icp_tracking/path");
  loadSeeking();
  SimulationOptions way = smallRoom(30);
  way.fps = 8.0;
  std::vector<RgbdFrame> frames = simulatedFrames(way);
  for (size_t i = 30; i-- > 0;) {
    frames.push_back(frames[i]);
    frames.back().stamp_s = frames[frames.size() - 2].stamp_s + 0.125;
  }
  for (size_t i = 0; i + 1 < frames.size(); ++i) ASSERT_NE(track(frames[i]), nullptr);
  const auto moved = map_status_.await([](const MapStatus& status) { return status.moved_m > 0.0; });
  std::string said;
  for (const auto& loop : loops.all()) said += loop->text + "\n";
  ASSERT_NE(moved, nullptr) << "no loop moved the map: " << said;
  EXPECT_NE(moved->generation, map_status_.all().front()->generation);
  EXPECT_NE(loops.await([](const LoopStatus& loop) { return loop.verdict == "closed"; }), nullptr);
  expectTracked(frames.back(), frames.front());
  EXPECT_NE(paths.await([](const nav_msgs::Path& path) { return path.poses.size() > 40; }), nullptr);
}

TEST_F(RefinedMap, IsRefusedWhereThereAreNoKeyframes) {
  graph_.handle().setParam("tsdf_fusion/close_loops", false);
  loadTracking();
  fuseAll({frames_.front()});
  const RefineMap::Response refused = refine();
  EXPECT_FALSE(refused.success);
  EXPECT_NE(refused.message.find("close_loops"), std::string::npos) << refused.message;
}

// The sensor is carried elsewhere, unseen, and goes back to where it began: what it mapped there is joined
// with the rest, and the robot is told where it is.
TEST_F(RefinedMap, JoinsAPartThatALostSensorMapped) {
  graph_.handle().setParam("relocalisation/lost_s", 0.5);
  loadSeeking();
  SimulationOptions way = smallRoom(200);
  way.scene = "large_room";
  std::vector<RgbdFrame> frames = simulatedFrames(way);
  const std::vector<RgbdFrame> back(frames.rbegin(), frames.rend());
  frames.resize(45);
  for (const RgbdFrame& frame : back) {
    frames.push_back(frame);
    frames.back().stamp_s = frames[frames.size() - 2].stamp_s + 1.0 / way.fps;
  }
  for (size_t i = 0; i + 1 < frames.size(); ++i) ASSERT_NE(track(frames[i]), nullptr);
  const auto begun =
      tracker_status_.await([](const TrackerStatus& status) { return status.prior == "part start"; });
  ASSERT_NE(begun, nullptr);
  EXPECT_EQ(begun->state, TrackerStatus::DEGENERATE);
  EXPECT_NE(begun->map_doubt.find("until a loop joins it"), std::string::npos) << begun->map_doubt;
  const auto moved = map_status_.await([](const MapStatus& status) { return status.moved_m > 0.5; });
  ASSERT_NE(moved, nullptr) << "no loop joined the parts";
  expectTracked(frames.back(), frames.front());
  EXPECT_EQ(tracker_status_.all().back()->map_doubt, "");
}

}  // namespace
}  // namespace depth_fusion
