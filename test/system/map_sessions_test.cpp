// A recording in two sessions, by the apps: the first one's map is kept, and the second one goes on with it.
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <thread>

#include "depth_fusion/recording/trajectory_file.h"
#include "support/apps.h"
#include "support/real_data.h"
#include "support/stored_maps.h"
#include "support/test_compute.h"
#include "tools/evaluation/trajectory_error.h"

namespace depth_fusion {
namespace {

namespace fs = std::filesystem;

constexpr double kHalf_s = 1305031110.45;  // of freiburg1_xyz: 250 frames are before it

// The part of a recording in the TUM layout before or after a stamp.
void linkPart(const std::string& recording, const std::string& folder, bool is_first) {
  fs::create_directory(folder);
  for (const char* images : {"depth", "rgb"}) {
    fs::create_directory_symlink(fs::absolute(recording + "/" + images), folder + "/" + images);
    std::istringstream all(fileBytes(recording + "/" + images + ".txt"));
    std::ofstream part(folder + "/" + images + ".txt");
    for (std::string line; std::getline(all, line);) {
      if (line[0] != '#' && (std::stod(line) < kHalf_s) == is_first) part << line << "\n";
    }
  }
}

class MapSessions : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(recording_)) GTEST_SKIP() << recording_ << " is not there";
    linkPart(recording_, folder_ / "monday", true);
    linkPart(recording_, folder_ / "tuesday", false);
  }
  AppRun reconstruct(const std::string& input, const std::string& output,
                     const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {
        "--no-mesh", "--params", "cfg/kinect_v1.yaml", "--camera",      "cfg/cameras/tum_freiburg1.yaml",
        "--input",   input,      "--output",           folder_ / output};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runApp("reconstruct", arguments);
  }

  const std::string recording_ = realDataFolder("tum_fr1_xyz");
  TemporaryFolder folder_;
  const std::string map_ = folder_ / "desk.map";
};

TEST_F(MapSessions, TheSecondIsFoundInItsFirstFrameAndAsAccurateAsOneRun) {
  const AppRun first = reconstruct(folder_ / "monday", "out1", {"--map", map_});
  ASSERT_EQ(first.status, 0) << first.errors;
  const AppRun second = reconstruct(folder_ / "tuesday", "out2", {"--continue", map_});
  ASSERT_EQ(second.status, 0) << second.errors;
  EXPECT_NE(second.output.find("frame 1: found in the map"), std::string::npos) << second.output;
  EXPECT_EQ(readReport(folder_ / "out2")["frames"]["lost"], 0);
  Trajectory both = readTrajectory(folder_ / "out1/trajectory.txt");
  const Trajectory rest = readTrajectory(folder_ / "out2/trajectory.txt");
  both.insert(both.end(), rest.begin(), rest.end());
  EXPECT_EQ(both.size(), 500u);
  const TrajectoryError error = compareTrajectories(both, readPoses(recording_));
  EXPECT_LE(error.ate_m.rmse, 1.05 * 0.0103);

  const AppRun info = runApp("map_info", {map_});
  EXPECT_EQ(info.status, 0) << info.errors;
  EXPECT_NE(info.output.find("for the 2. time"), std::string::npos) << info.output;
}

// Two robots: each has a map of its own, and a world of its own.
TEST_F(MapSessions, TwoMapsBecomeOne) {
  const std::string other = folder_ / "other.map";
  ASSERT_EQ(reconstruct(folder_ / "monday", "out1", {"--map", map_}).status, 0);
  ASSERT_EQ(reconstruct(folder_ / "tuesday", "out2", {"--map", other}).status, 0);
  const AppRun refused = runApp("merge_maps", {map_, other, "--output", map_});
  EXPECT_EQ(refused.status, 1);
  EXPECT_NE(refused.errors.find("another place"), std::string::npos) << refused.errors;
  const AppRun merged = runApp("merge_maps", {map_, other, "--output", folder_ / "both.map"});
  ASSERT_EQ(merged.status, 0) << merged.errors;
  const size_t said = merged.output.find("second map:");
  ASSERT_NE(said, std::string::npos) << merged.output;
  Eigen::Vector3d t;
  Eigen::Quaterniond q;
  ASSERT_EQ(
      std::sscanf(merged.output.c_str() + said, "second map: at %lf %lf %lf m, turned by %lf %lf %lf %lf",
                  &t.x(), &t.y(), &t.z(), &q.x(), &q.y(), &q.z(), &q.w()),
      7);
  const Pose T_A_B = orthonormalized(Eigen::Translation3d(t) * q.normalized());
  Trajectory both = readTrajectory(folder_ / "out1/trajectory.txt");
  for (const StampedPose& pose : readTrajectory(folder_ / "out2/trajectory.txt"))
    both.push_back({pose.stamp_s, T_A_B * pose.T_W_D});
  EXPECT_LE(compareTrajectories(both, readPoses(recording_)).ate_m.rmse, 0.013);
  EXPECT_EQ(runApp("map_info", {folder_ / "both.map"}).status, 0);
  EXPECT_EQ(
      reconstruct(folder_ / "tuesday", "out3", {"--continue", folder_ / "both.map", "--max-frames", "30"})
          .status,
      0);
}

TEST_F(MapSessions, ASensorThatIsElsewhereIsNotFoundAndNothingChanges) {
  const std::string kitchen = realDataFolder("redkitchen");
  if (!fs::exists(kitchen)) GTEST_SKIP() << kitchen << " is not there";
  const AppRun other =
      runApp("reconstruct", {"--no-mesh", "--max-frames", "100", "--params", "cfg/kinect_v1.yaml", "--input",
                             kitchen, "--output", folder_ / "out1", "--map", map_});
  ASSERT_EQ(other.status, 0) << other.errors;
  const std::string before = fileBytes(map_);
  const AppRun lost = reconstruct(folder_ / "tuesday", "out2", {"--continue", map_, "--max-frames", "60"});
  EXPECT_EQ(lost.status, 1) << lost.output;
  EXPECT_EQ(readReport(folder_ / "out2")["frames"]["tracked"], 0);
  EXPECT_TRUE(fileBytes(map_) == before);
}

TEST_F(MapSessions, WhatCannotBeGoneOnWithIsSaidAtTheStart) {
  const auto expectRefused = [&](const std::vector<std::string>& options, const std::string& word) {
    const AppRun run = reconstruct(folder_ / "monday", "out", options);
    EXPECT_EQ(run.status, 1);
    EXPECT_NE(run.errors.find(word), std::string::npos) << run.errors;
  };
  expectRefused({"--continue", folder_ / "none.map"}, "there is no map");
  expectRefused({"--map", folder_ / "no/such/folder/x.map"}, "cannot be written");
  std::ofstream(folder_ / "notes.txt") << "notes";
  expectRefused({"--continue", folder_ / "notes.txt"}, "notes.txt");
  const AppRun info = runApp("map_info", {folder_ / "notes.txt"});
  EXPECT_EQ(info.status, 1);
  EXPECT_NE(info.errors.find("notes.txt"), std::string::npos) << info.errors;
}

// Others see whole saves only, whenever they look.
TEST(StoredMap, IsReadByAnotherProcessWhileItIsSaved) {
  TemporaryFolder folder;
  const std::string path = folder / "ball.map";
  BlockMap map(compute(), smallMap());
  ChangingMap changing(compute(), map);
  MapSaver saver(path);
  changing.show(sphere(Eigen::Vector3d::Zero(), 0.12));
  save(saver, map);
  std::atomic<bool> ends{false};
  std::thread readers([&] {
    for (int i = 0; i < 8; ++i) {
      const AppRun info = runApp("map_info", {path});
      EXPECT_EQ(info.status, 0) << info.errors;
    }
    ends = true;
  });
  int saves = 0;
  for (; !ends; ++saves) {
    changing.show(sphere({0.01 * (saves % 4), 0.0, 0.0}, 0.12 + 0.01 * (saves % 7)));
    save(saver, map, {someKeyframe(saves)});
  }
  readers.join();
  EXPECT_GT(saves, 8);
}

}  // namespace
}  // namespace depth_fusion
