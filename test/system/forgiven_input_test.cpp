// Recordings as they come, and what `reconstruct` makes of them.
#include <gtest/gtest.h>
#include <rosbag/view.h>

#include "common/io/image_file.h"
#include "common/io/text_file.h"
#include "depth_fusion/frames/y_down.h"
#include "depth_fusion/recording/trajectory_file.h"
#include "recording/timed_files.h"
#include "support/apps.h"
#include "support/bag_messages.h"

namespace depth_fusion {
namespace {

namespace fs = std::filesystem;

constexpr int kFrames = 6;

class ForgivenInput : public testing::Test {
 protected:
  ForgivenInput() {
    const AppRun run = runApp("simulate", {"--output", room(), "--frames", std::to_string(kFrames)});
    EXPECT_EQ(run.status, 0) << run.errors;
  }

  std::string room() const { return folder_ / "room"; }
  std::string out() const { return folder_ / "out"; }

  AppRun reconstruct(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "--input");
    arguments.insert(arguments.end(),
                     {"--output", out(), "--voxel-size", "0.02", "--blocks-per-axis", "128"});
    return runApp("reconstruct", arguments);
  }

  void expectFused(const AppRun& run, int frames) const {
    EXPECT_EQ(run.status, 0) << run.errors;
    EXPECT_EQ(readReport(out())["frames"]["tracked"], frames) << run.errors;
  }

  TemporaryFolder folder_;
};

TEST_F(ForgivenInput, status_says_that_most_frames_were_lost) {
  const std::vector<TimedFile> files = readTimedFiles(room() + "/depth.txt");
  for (size_t i = 2; i < files.size(); ++i) writePng(files[i].path, cv::Mat::zeros(480, 640, CV_16UC1));
  const AppRun run = reconstruct({room()});
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.errors.find("4 of 6 frames were lost, the first of them frame 3"), std::string::npos)
      << run.errors;
  EXPECT_EQ(readReport(out())["frames"]["tracked"], 2);
}

TEST_F(ForgivenInput, noise_is_said_as_soon_as_a_frame_shows_it) {
  writePng(readTimedFiles(room() + "/depth.txt").front().path, cv::Mat::zeros(480, 640, CV_16UC1));
  const std::string params = folder_ / "exact_sensor.yaml";
  writeText(params, "depth_sensor: {sigma_base_m: 0.0003, sigma_growth_per_m: 0.0004}\n");
  const AppRun run = reconstruct({room(), "--params", params});
  EXPECT_NE(run.output.find("frame 2: depth has a sigma of"), std::string::npos) << run.output;
}

// As ICL-NUIM has it: fy < 0, and poses of a camera with y up in a world with y up.
TEST_F(ForgivenInput, y_up_is_turned_down_and_so_are_poses) {
  const std::string poses = room() + "/groundtruth.txt";
  const AppRun down = reconstruct({room(), "--trajectory", poses});
  expectFused(down, kFrames);
  const auto blocks = readReport(out())["map"]["blocks"];
  const Trajectory original = readTrajectory(poses);
  Trajectory mirrored = original;
  for (StampedPose& pose : mirrored) pose.T_W_D = mirroredY(pose.T_W_D);
  writeTrajectory(poses, mirrored);
  std::string camera = fileBytes(room() + "/camera.yaml");
  camera.replace(camera.find("fy: "), 4, "fy: -");
  writeText(room() + "/camera.yaml", camera);
  const AppRun up = reconstruct({room(), "--trajectory", poses});
  expectFused(up, kFrames);
  EXPECT_NE(up.output.find("y is up"), std::string::npos) << up.output;
  EXPECT_EQ(readReport(out())["map"]["blocks"], blocks);
  const Trajectory used = readTrajectory(out() + "/trajectory.txt");
  for (size_t i = 0; i < used.size(); ++i) EXPECT_TRUE(used[i].T_W_D.isApprox(original[i].T_W_D, 1e-6)) << i;
}

TEST_F(ForgivenInput, parts_of_a_split_bag_are_one_recording) {
  ASSERT_EQ(
      runApp("simulate", {"--output", folder_ / "room.bag", "--frames", std::to_string(kFrames)}).status, 0);
  {
    rosbag::Bag whole(folder_ / "room.bag"), first(folder_ / "0.bag", rosbag::bagmode::Write),
        second(folder_ / "1.bag", rosbag::bagmode::Write);
    rosbag::View view(whole);
    const ros::Time middle = view.getBeginTime() + (view.getEndTime() - view.getBeginTime()) * 0.5;
    for (const rosbag::MessageInstance& place : view)
      (place.getTime() < middle ? first : second).write(place.getTopic(), place.getTime(), place);
  }
  expectFused(reconstruct({folder_ / "0.bag", folder_ / "1.bag"}), kFrames);
  // The other apps take them as reconstruct does.
  const AppRun plan =
      runApp("plan_resolution", {"--input", folder_ / "0.bag", folder_ / "1.bag", "--output", out()});
  EXPECT_EQ(plan.status, 0) << plan.errors;
  EXPECT_NE(plan.output.find("frame 6/6"), std::string::npos) << plan.output;
  const AppRun calibration =
      runApp("calibrate", {"--input", folder_ / "0.bag", folder_ / "1.bag", "--output", out()});
  EXPECT_NE(calibration.output.find("6 depth images"), std::string::npos)
      << calibration.output << calibration.errors;
}

TEST_F(ForgivenInput, what_many_frames_have_in_common_is_said_once) {
  ASSERT_EQ(
      runApp("simulate", {"--output", folder_ / "room.bag", "--frames", std::to_string(kFrames)}).status, 0);
  {
    rosbag::Bag whole(folder_ / "room.bag"), spoilt(folder_ / "spoilt.bag", rosbag::bagmode::Write);
    rosbag::View view(whole);
    int images = 0;
    for (const rosbag::MessageInstance& place : view) {
      const auto image = place.instantiate<sensor_msgs::Image>();
      const bool is_depth = image != nullptr && image->encoding != "bgr8";
      if (is_depth && ++images > 3) image->encoding = "bgr8";
      if (image != nullptr) {
        spoilt.write(place.getTopic(), place.getTime(), *image);
      } else {
        spoilt.write(place.getTopic(), place.getTime(), place);
      }
    }
  }
  const AppRun run = reconstruct({folder_ / "spoilt.bag"});
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(readReport(out())["frames"]["tracked"], 3) << run.errors;
  EXPECT_EQ(std::count(run.errors.begin(), run.errors.end(), '\n'), 2) << run.errors;
  EXPECT_NE(run.errors.find("3 of 6 frames could not be read"), std::string::npos) << run.errors;
}

TEST_F(ForgivenInput, poses_with_a_header_and_a_line_that_was_cut_short_are_used) {
  const std::string poses = folder_ / "poses.csv";
  std::string text = fileBytes(room() + "/groundtruth.txt");
  text.erase(0, text.find('\n') + 1);
  std::replace(text.begin(), text.end(), ' ', ',');
  writeText(poses, "stamp,x,y,z,qx,qy,qz,qw\n" + text + "2.5,0.1,0.2");
  const AppRun run = reconstruct({room(), "--trajectory", poses});
  expectFused(run, kFrames);
  EXPECT_NE(run.errors.find("2 lines left out, the first: " + poses + ":1"), std::string::npos) << run.errors;
}

TEST_F(ForgivenInput, colour_of_another_size_is_named_once_and_costs_no_frame) {
  for (const TimedFile& file : readTimedFiles(room() + "/rgb.txt"))
    writePng(file.path, cv::Mat(240, 320, CV_8UC3, cv::Scalar(10, 20, 30)));
  const AppRun run = reconstruct({room()});
  expectFused(run, kFrames);
  EXPECT_EQ(std::count(run.errors.begin(), run.errors.end(), '\n'), 1) << run.errors;
  for (const char* word : {"320x240", "640x480", "intrinsics"})
    EXPECT_NE(run.errors.find(word), std::string::npos) << run.errors;
}

// Whatever is wrong with the camera that was given for it.
TEST_F(ForgivenInput, a_colour_camera_that_is_none_is_named_once_and_costs_no_frame) {
  const std::string file = folder_ / "color.yaml";
  const std::map<std::string, std::string> faults = {
      {"", "there is no such file"},
      {"width: 640\nheight: 480\nfx: 525\n", "fy"},
      {"width: 640\nheight: 480\nfx: 1\nfy: 1\ncx: 0\ncy: 0\n", "not valid"},
      {"width: 320\nheight: 240\nfx: 262\nfy: 262\ncx: 160\ncy: 120\n", "320x240"}};
  for (const auto& [content, words] : faults) {
    if (!content.empty()) writeText(file, content);
    const AppRun run = reconstruct({room(), "--color-camera", file});
    expectFused(run, kFrames);
    EXPECT_EQ(std::count(run.errors.begin(), run.errors.end(), '\n'), 1) << run.errors;
    if (!content.empty()) {
      EXPECT_NE(run.errors.find(words), std::string::npos) << run.errors;
    }
  }
}

TEST_F(ForgivenInput, impossible_intrinsics_are_refused) {
  for (const char* intrinsics : {"1,1,0,0", "525,525,700,240", "525,nan,320,240", "0,525,320,240"}) {
    const AppRun run = reconstruct({room(), "--intrinsics", intrinsics});
    EXPECT_EQ(run.status, 1) << intrinsics;
    for (const char* word : {"not valid", "--intrinsics"})
      EXPECT_NE(run.errors.find(word), std::string::npos) << run.errors;
  }
}

}  // namespace
}  // namespace depth_fusion
