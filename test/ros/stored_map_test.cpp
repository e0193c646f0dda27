// Maps of a live graph, saved and loaded by services, kept in a file from one start to the next.
#include <depth_fusion/ClearRegion.h>
#include <depth_fusion/LoadMap.h>
#include <depth_fusion/SaveMap.h>

#include <filesystem>
#include <fstream>

#include "depth_fusion/submaps/map_check.h"
#include "depth_fusion/submaps/map_file.h"
#include "support/file_bytes.h"
#include "support/live_graph.h"
#include "support/postgres_server.h"
#include "support/temporary_folder.h"

namespace depth_fusion {
namespace {

class StoredMap : public LiveGraph {
 protected:
  SaveMap::Response save(const std::string& path) {
    SaveMap service;
    service.request.path = path;
    EXPECT_TRUE(call<SaveMap>("tsdf_fusion/save_map", service.request, service.response));
    return service.response;
  }
  LoadMap::Response load(const std::string& path, bool read_only = false) {
    LoadMap service;
    service.request.path = path;
    service.request.read_only = read_only;
    EXPECT_TRUE(call<LoadMap>("tsdf_fusion/load_map", service.request, service.response));
    return service.response;
  }
  void unloadAll() {
    for (const char* name : {"texture_odometry", "icp_tracking", "tsdf_fusion"})
      ASSERT_TRUE(graph_.unload(name));
  }
  // A nodelet may end a moment after its unloading has returned.
  bool awaitRevision(uint64_t revision) {
    return eventually([&] {
      const std::unique_ptr<Database> stored = openStoredMap(path_);
      return stored != nullptr && describeMap(*stored).revision == revision;
    });
  }
  Pose poseAt(const RgbdFrame& frame) {
    const auto pose = poses_.awaitStamp(camera_.headerOf(frame).stamp);
    EXPECT_NE(pose, nullptr) << "no pose of " << frame.stamp_s;
    return pose == nullptr ? Pose::Identity() : fromMessage(pose->pose.pose);
  }
  // A map of some frames, saved there. Returns where the next frame is in it.
  Pose saveSomeFrames(const std::string& path) {
    loadTracking();
    fuseAll({frames_.begin(), frames_.end() - 2});
    const SaveMap::Response saved = save(path);
    EXPECT_TRUE(saved.success) << saved.message;
    EXPECT_GT(saved.bytes, 10000u);
    EXPECT_EQ(saved.submaps, 1u);
    fuseAll({frames_[frames_.size() - 2]});
    return poseAt(frames_[frames_.size() - 2]);
  }
  // The frame as the driver sends it after all that there are.
  RgbdFrame later(RgbdFrame frame) {
    frame.stamp_s = last_stamp_s_ += 0.1;
    return frame;
  }

  const std::vector<RgbdFrame> frames_ = simulatedFrames(smallRoom(10));
  const RgbdFrame& next_ = frames_[frames_.size() - 2];
  double last_stamp_s_ = frames_.back().stamp_s;
  TemporaryFolder folder_;
  const std::string path_ = folder_ / "room.map";
};

TEST_F(StoredMap, TheSensorIsFoundInTheFirstFrame) {
  const Pose T_map_next = saveSomeFrames(path_);
  resetVolume();
  const RgbdFrame begins_anew = later(frames_.front());
  fuseAll({begins_anew});
  const LoadMap::Response loaded = load(path_);
  ASSERT_TRUE(loaded.success) << loaded.message;
  EXPECT_EQ(loaded.submaps, 1u);
  EXPECT_GT(loaded.bytes, 10000u);
  const RgbdFrame again = later(next_);
  fuseAll({again});
  expectPose(poseAt(again), T_map_next);
  const auto tracked = tracker_status_.awaitStamp(camera_.headerOf(again).stamp);
  EXPECT_EQ(tracked->state, TrackerStatus::TRACKING);
  EXPECT_GT(tracked->keyframes, 0u);
}

// A part of the map is forgotten where tf says that it is; the rest stays.
TEST_F(StoredMap, ARegionIsClearedInAnyFrame) {
  saveSomeFrames(path_);
  const uint64_t blocks = map_status_.all().back()->blocks;
  ClearRegion region;
  region.request.pose.orientation.w = 1.0;
  const auto clear = [&] {
    EXPECT_TRUE(call<ClearRegion>("tsdf_fusion/clear_region", region.request, region.response));
    return region.response;
  };
  EXPECT_FALSE(clear().success) << "it has no size";
  region.request.radius = 0.1;
  region.request.header.frame_id = "no_such_frame";
  EXPECT_NE(clear().message.find("no_such_frame"), std::string::npos) << region.response.message;
  region.request.header.frame_id = "map";
  region.request.radius = 100.0;
  EXPECT_TRUE(clear().success) << region.response.message;
  EXPECT_EQ(region.response.blocks, blocks);
  const SaveMap::Response nothing_left = save(folder_ / "cleared.map");
  EXPECT_FALSE(nothing_left.success);
  EXPECT_NE(nothing_left.message.find("empty"), std::string::npos) << nothing_left.message;
}

TEST_F(StoredMap, LocalisationChangesNoByte) {
  const Pose T_map_next = saveSomeFrames(path_);
  const std::string before = fileBytes(path_);
  const LoadMap::Response loaded = load(path_, true);
  ASSERT_TRUE(loaded.success) << loaded.message;
  const RgbdFrame again = later(next_);
  const auto status = fuse(again);
  ASSERT_NE(status, nullptr);
  EXPECT_FALSE(status->fused);
  EXPECT_EQ(status->mode, MapStatus::LOCALISATION);
  expectPose(poseAt(again), T_map_next);
  EXPECT_EQ(fileBytes(path_), before);
}

TEST_F(StoredMap, WhatCannotBeLoadedOrSavedIsSaidAndTheMapStays) {
  saveSomeFrames(path_);
  const auto expectRefused = [](const auto& response, const std::string& word) {
    EXPECT_FALSE(response.success);
    EXPECT_NE(response.message.find(word), std::string::npos) << response.message;
  };
  expectRefused(load(folder_ / "none.map"), "none.map");
  expectRefused(load(""), "path is empty");
  expectRefused(save(""), "path is empty");
  expectRefused(save(folder_ / "no/such/folder/x.map"), "x.map");
  std::string damaged = fileBytes(path_);
  for (size_t i = 20000; i < damaged.size(); i += 1000) damaged[i] = static_cast<char>(damaged[i] ^ 0x10);
  std::ofstream(folder_ / "damaged.map", std::ios::binary) << damaged;
  expectRefused(load(folder_ / "damaged.map"), "damaged.map");
  fuseAll({frames_.back()});
  EXPECT_EQ(map_status_.all().back()->generation, map_status_.all().front()->generation);
  resetVolume();
  expectRefused(save(path_), "the map is empty");
}

TEST_F(StoredMap, AMapIsKeptFromOneStartToTheNext) {
  graph_.handle().setParam("tsdf_fusion/map_file", path_);
  loadTracking();
  fuseAll({frames_.begin(), frames_.end() - 2});
  fuseAll({next_});
  const Pose T_map_next = poseAt(next_);
  const uint64_t blocks = map_status_.all().back()->blocks;
  unloadAll();
  ASSERT_TRUE(awaitRevision(1));
  EXPECT_EQ(checkMap(*openDatabase(path_, DatabaseAccess::kRead)).blocks.at("tsdf"), blocks);

  loadTracking();
  const RgbdFrame again = later(next_);
  fuseAll({again});
  expectPose(poseAt(again), T_map_next);
  EXPECT_GE(map_status_.all().back()->blocks, 9 * blocks / 10) << "it went on from the kept one";
  unloadAll();
  EXPECT_TRUE(awaitRevision(2));
}

TEST_F(StoredMap, ItIsSavedFromTimeToTime) {
  graph_.handle().setParam("tsdf_fusion/map_file", path_);
  graph_.handle().setParam("tsdf_fusion/save_period_s", 0.1);
  loadTracking();
  fuseAll({frames_[0]});
  const auto savedBlocks = [&]() -> uint64_t {
    const std::unique_ptr<Database> stored = openStoredMap(path_);
    return stored == nullptr ? 0 : describeMap(*stored).submaps.front().blocks;
  };
  EXPECT_TRUE(eventually([&] { return savedBlocks() == map_status_.all().back()->blocks; }));
  fuseAll({frames_[1], frames_[2]});
  EXPECT_TRUE(eventually([&] { return savedBlocks() == map_status_.all().back()->blocks; }));
}

TEST_F(StoredMap, AnEmptiedMapDoesNotTakeThePlaceOfTheKeptOne) {
  graph_.handle().setParam("tsdf_fusion/map_file", path_);
  saveSomeFrames("");
  resetVolume();
  fuseAll({later(frames_.front())});
  const std::string before = fileBytes(path_);
  unloadAll();
  EXPECT_EQ(fileBytes(path_), before);
}

TEST_F(StoredMap, AReadOnlyMapIsNeverSavedAndWithoutOneNothingIsMapped) {
  saveSomeFrames(path_);
  unloadAll();
  const std::string before = fileBytes(path_);
  graph_.handle().setParam("tsdf_fusion/map_file", path_);
  graph_.handle().setParam("tsdf_fusion/read_only", true);
  loadTracking();
  const RgbdFrame again = later(next_);
  const auto status = fuse(again);
  ASSERT_NE(status, nullptr);
  EXPECT_FALSE(status->fused);
  EXPECT_EQ(status->mode, MapStatus::LOCALISATION);
  EXPECT_FALSE(save("").success);
  unloadAll();
  EXPECT_EQ(fileBytes(path_), before);

  graph_.handle().setParam("tsdf_fusion/map_file", folder_ / "none.map");
  loadTracking();
  const auto paused = track(later(next_));
  ASSERT_NE(paused, nullptr);
  EXPECT_EQ(paused->state, TrackerStatus::PAUSED);
}

TEST_F(StoredMap, ADamagedFileIsLeftAloneAndMappingGoesOn) {
  const std::string nonsense(20000, 'x');
  std::ofstream(path_) << nonsense;
  graph_.handle().setParam("tsdf_fusion/map_file", path_);
  loadTracking();
  fuseAll({frames_[0], frames_[1]});
  unloadAll();
  EXPECT_EQ(fileBytes(path_), nonsense);
}

// Without texture there are no keyframes, and the map's last pose is too far away to search from.
TEST_F(StoredMap, APoseThatIsGivenFindsTheSensor) {
  graph_.handle().setParam("icp_tracking/texture_odometry", false);
  ASSERT_TRUE(graph_.load("tsdf_fusion"));
  ASSERT_TRUE(graph_.load("icp_tracking"));
  awaitTracking();
  const std::vector<RgbdFrame> frames = simulatedFrames(smallRoom(90));
  const Pose motion = frames.front().T_W_D->inverse() * *frames.back().T_W_D;
  ASSERT_GT(motion.translation().norm() / 0.5 + rotationAngle(motion) / 0.5, 1.0);
  fuseAll(frames);
  last_stamp_s_ = frames.back().stamp_s;
  const Pose T_map_first = poseAt(frames.front());
  ASSERT_TRUE(save(path_).success);
  ASSERT_TRUE(load(path_).success);
  const auto lost = track(later(frames.front()));
  ASSERT_NE(lost, nullptr);
  EXPECT_EQ(lost->state, TrackerStatus::LOST);

  ros::Publisher given =
      graph_.handle().advertise<geometry_msgs::PoseWithCovarianceStamped>("/initialpose", 1);
  ASSERT_TRUE(eventually([&] { return given.getNumSubscribers() > 0; }));
  // The camera began level at the map's origin; a hand points beside it.
  geometry_msgs::PoseWithCovarianceStamped origin;
  origin.header.frame_id = "map";
  origin.pose.pose.position.x = 0.15;
  origin.pose.pose.position.y = -0.1;
  origin.pose.pose.orientation.w = 1.0;
  given.publish(origin);
  TrackerStatus::ConstPtr status;
  RgbdFrame again;
  ASSERT_TRUE(eventually([&] {
    again = later(frames.front());
    status = track(again);
    return status != nullptr && status->state == TrackerStatus::TRACKING;
  }));
  EXPECT_EQ(status->prior, "search");
  expectPose(poseAt(again), T_map_first);
}

TEST_F(StoredMap, AMapIsKeptOnAServer) {
  if (PostgresServer::programs().empty()) GTEST_SKIP() << "no PostgreSQL server here";
  PostgresServer server;
  const Pose T_map_next = saveSomeFrames(server.uri("room"));
  resetVolume();
  const LoadMap::Response loaded = load(server.uri("room"));
  ASSERT_TRUE(loaded.success) << loaded.message;
  EXPECT_EQ(loaded.message.find(PostgresServer::kPassword), std::string::npos) << loaded.message;
  const RgbdFrame again = later(next_);
  const auto found = track(again);
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(found->state, TrackerStatus::TRACKING) << found->reason;
  expectPose(poseAt(again), T_map_next);
  server.stop();
  const SaveMap::Response failed = save(server.uri("room"));
  EXPECT_FALSE(failed.success);
  EXPECT_NE(failed.message.find("cannot be reached"), std::string::npos) << failed.message;
  fuseAll({later(frames_.back())});
  server.start();
  const SaveMap::Response saved = save(server.uri("room"));
  EXPECT_TRUE(saved.success) << saved.message;
}

}  // namespace
}  // namespace depth_fusion
