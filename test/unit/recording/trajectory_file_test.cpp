#include "depth_fusion/recording/trajectory_file.h"

#include <gtest/gtest.h>

#include "common/io/text_file.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace depth_fusion {
namespace {

Pose poseOf(double angle_rad, const Eigen::Vector3d& p_W) {
  Vector6d twist;
  twist << angle_rad * Eigen::Vector3d(1.0, -2.0, 0.5).normalized(), p_W;
  return poseFromTwist(twist);
}

Trajectory testTrajectory() {
  return {{1.0 / 30.0, poseOf(0.1, {0.123456789, -2.0, 3.0})},
          {1305031102.160407, poseOf(-2.5, {1e-6, 1234.5, -0.25})},
          {1305031102.1604073, poseOf(3.1, {0.0, 0.0, 0.0})}};
}

TEST(TrajectoryFile, reads_back_what_it_wrote) {
  const TemporaryFolder folder;
  const Trajectory written = testTrajectory();
  writeTrajectory(folder / "t.txt", written);
  const Trajectory read = readTrajectory(folder / "t.txt");
  ASSERT_EQ(read.size(), written.size());
  for (size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].stamp_s, written[i].stamp_s);
    EXPECT_TRUE(read[i].T_W_D.matrix().isApprox(written[i].T_W_D.matrix(), 2e-9)) << i;
  }
}

TEST(TrajectoryFile, writes_the_tum_format) {
  const TemporaryFolder folder;
  StampedPose pose;
  pose.stamp_s = 1305031102.160407;
  pose.T_W_D.translation() << 1.5, -2.0, 0.0;
  writeTrajectory(folder / "t.txt", {pose});
  const auto lines = readTextLines(folder / "t.txt");
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].text,
            "1305031102.160407 1.500000000 -2.000000000 0.000000000 0.000000000 0.000000000 0.000000000 "
            "1.000000000");
}

TEST(TrajectoryFile, sorts_and_skips_comments_and_takes_commas) {
  const TemporaryFolder folder;
  writeText(folder / "t.txt", "# stamp ...\r\n\n2.0 1 0 0 0 0 0 1 # second\r\n1.0, 2, 0, 0, 0, 0, 1, 0\n");
  const Trajectory read = readTrajectory(folder / "t.txt");
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[0].stamp_s, 1.0);
  EXPECT_EQ(read[0].T_W_D.translation().x(), 2.0);
  EXPECT_NEAR(read[0].T_W_D.linear()(0, 0), -1.0, 1e-12);
  EXPECT_EQ(read[1].stamp_s, 2.0);
}

TEST(TrajectoryFile, normalises_rounded_quaternions) {
  const TemporaryFolder folder;
  writeText(folder / "t.txt", "0 0 0 0 0.6132 0.5962 -0.3311 -0.3986\n");
  const Eigen::Matrix3d rotation = readTrajectory(folder / "t.txt")[0].T_W_D.linear();
  EXPECT_TRUE((rotation * rotation.transpose()).isIdentity(1e-12));
}

TEST(TrajectoryFile, takes_quaternions_of_any_length_and_leaves_out_poses_that_are_none) {
  const TemporaryFolder folder;
  writeText(folder / "t.txt",
            "1 0 0 0 0 0 0 0\n2 nan 0 0 0 0 0 1\n3 0 0 -inf 0 0 0 1\n4 1.#INF 0 0 0 0 0 1\n"
            "5 0 0 0 -1.#IND 0 0 1\n6 0 0 Infinity 0 0 0 1\n7 0 0 -nan(ind) 0 0 0 1\n8 1 2 3 0 0 2 2\n");
  const Trajectory read = readTrajectory(folder / "t.txt");
  ASSERT_EQ(read.size(), 1u);
  EXPECT_EQ(read[0].stamp_s, 8.0);
  EXPECT_TRUE(read[0].T_W_D.translation().isApprox(Eigen::Vector3d(1.0, 2.0, 3.0)));
  EXPECT_NEAR(read[0].T_W_D.linear()(1, 0), 1.0, 1e-12) << "a quarter turn about z";
  writeText(folder / "t.txt", "1 0 0 0 0 0 0 0\n");
  expectError([&] { readTrajectory(folder / "t.txt"); }, {folder / "t.txt", "no pose"});
}

TEST(TrajectoryFile, takes_stamps_in_any_unit) {
  const TemporaryFolder folder;
  for (const char* stamp : {"1403636579.75", "1403636579750", "1403636579750000", "1403636579750000000"}) {
    writeText(folder / "t.txt", std::string(stamp) + " 0 0 0 0 0 0 1\n");
    EXPECT_NEAR(readTrajectory(folder / "t.txt")[0].stamp_s, 1403636579.75, 1e-6) << stamp;
  }
}

TEST(TrajectoryFile, names_what_it_cannot_read) {
  const TemporaryFolder folder;
  const std::string path = folder / "t.txt";
  const auto expectBadLine = [&](const std::string& line) {
    writeText(path, "0 0 0 0 0 0 0 1\n" + line + "\n");
    expectError([&] { readTrajectory(path); }, {path + ":2: "});
  };
  expectBadLine("1 0 0 0 0 0 0");
  expectBadLine("1 0 0 0 0 0 0 1 5");
  expectBadLine("1 0 zero 0 0 0 0 1");
  writeText(path, "# nothing\n");
  expectError([&] { readTrajectory(path); }, {path, "no pose"});
  expectError([&] { readTrajectory(folder / "missing.txt"); }, {"missing.txt", "No such file"});
  expectError([&] { readTrajectory(folder.path()); }, {folder.path()});
}

TEST(TrajectoryFile, lines_that_are_no_poses_are_left_out_and_said_where_somebody_listens) {
  const TemporaryFolder folder;
  const std::string path = folder / "t.txt";
  const std::string texts[] = {"timestamp,tx,ty,tz,qx,qy,qz,qw\n1,0,0,0,0,0,0,1\n2,1,0,0,0,0,0,1\n",
                               "1 0 0 0 0 0 0 1\r\n2 1 0 0 0 0 0 1\r\n3 1 0 0",
                               "1 0 0 0 0 0 0 1\nlost\n2 1 0 0 0 0 0 1\n"};
  for (const std::string& text : texts) {
    writeText(path, text);
    std::string remark;
    EXPECT_EQ(readTrajectory(path, &remark).size(), 2u) << text;
    EXPECT_EQ(remark.find("1 line left out: " + path + ":"), 0u) << remark;
  }
  writeText(path, "1 0 0 0 0 0 0\n2 0 0 0 0 0 0\n");
  std::string remark;
  expectError([&] { readTrajectory(path, &remark); }, {path + ":1", "is not a pose"});
}

TEST(TrajectoryFile, takes_decimal_commas) {
  const TemporaryFolder folder;
  writeText(folder / "t.txt", "1,5 -0,25 1,0e+1 3 0,0 0,0 0,0 1,0\n");
  const Trajectory read = readTrajectory(folder / "t.txt");
  EXPECT_EQ(read[0].stamp_s, 1.5);
  EXPECT_TRUE(read[0].T_W_D.translation().isApprox(Eigen::Vector3d(-0.25, 10.0, 3.0)));
}

TEST(TrajectoryFile, says_when_it_cannot_write) {
  const TemporaryFolder folder;
  expectError([&] { writeTrajectory(folder / "no/t.txt", {}); }, {folder / "no/t.txt", "cannot be written"});
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  expectError([] { writeTrajectory("/dev/full", testTrajectory()); }, {"/dev/full", "No space left"});
}

TEST(TrajectoryFile, interpolates_between_neighbours) {
  Trajectory trajectory(2);
  trajectory[0] = {10.0, poseOf(0.2, {0.0, 0.0, 0.0})};
  trajectory[1] = {10.4, poseOf(0.6, {4.0, 8.0, 0.0})};
  const auto pose = poseAt(trajectory, 10.1, 0.3 + 1e-9);
  ASSERT_TRUE(pose.has_value());
  EXPECT_TRUE(pose->isApprox(poseOf(0.3, {1.0, 2.0, 0.0}), 1e-9));
}

TEST(TrajectoryFile, gives_no_pose_across_a_gap_or_outside) {
  const Trajectory trajectory = {{10.0, Pose::Identity()}, {10.4, Pose::Identity()}};
  EXPECT_FALSE(poseAt(trajectory, 10.1, 0.2).has_value());
  EXPECT_FALSE(poseAt(trajectory, 10.3, 0.2).has_value());
  EXPECT_TRUE(poseAt(trajectory, 10.2, 0.2 + 1e-9).has_value());
  EXPECT_FALSE(poseAt(trajectory, 9.999, 1.0).has_value());
  EXPECT_FALSE(poseAt(trajectory, 10.401, 1.0).has_value());
  EXPECT_TRUE(poseAt(trajectory, 10.0, 0.0).has_value());
  EXPECT_TRUE(poseAt(trajectory, 10.4, 0.0).has_value());
  EXPECT_FALSE(poseAt({}, 10.0, 1.0).has_value());
}

}  // namespace
}  // namespace depth_fusion
