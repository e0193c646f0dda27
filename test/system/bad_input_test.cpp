// What the apps say about bad input: one line on standard error with what, where and what to do, a failing
// exit status, and what was fused so far written nevertheless.
#include <gtest/gtest.h>
#include <sys/mount.h>

#include <algorithm>

#include "common/io/image_file.h"
#include "common/io/text_file.h"
#include "depth_fusion/recording/trajectory_file.h"
#include "depth_fusion/surface_mesh/ply.h"
#include "recording/camera_file.h"
#include "recording/timed_files.h"
#include "support/apps.h"
#include "support/bag_messages.h"

namespace depth_fusion {
namespace {

namespace fs = std::filesystem;

constexpr int kFrames = 6;

// One line by the app that holds each of the words.
void expectComplaint(const AppRun& run, const std::vector<std::string>& words) {
  EXPECT_GT(run.status, 0);
  EXPECT_EQ(std::count(run.errors.begin(), run.errors.end(), '\n'), 1) << run.errors;
  for (const std::string& word : words) {
    EXPECT_NE(run.errors.find(word), std::string::npos) << "'" << word << "' is not in: " << run.errors;
  }
}

class BadInput : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    suite_folder_ = std::make_unique<TemporaryFolder>();
    const AppRun run =
        runApp("simulate", {"--output", *suite_folder_ / "room", "--frames", std::to_string(kFrames)});
    ASSERT_EQ(run.status, 0) << run.errors;
  }
  static void TearDownTestSuite() { suite_folder_.reset(); }

  static std::string room() { return *suite_folder_ / "room"; }
  std::string out() const { return folder_ / "out"; }

  // A copy of the simulated room to be spoilt.
  std::string roomCopy() const {
    fs::copy(room(), folder_ / "room", fs::copy_options::recursive);
    return folder_ / "room";
  }
  static std::string depthImage(const std::string& recording, size_t index) {
    return readTimedFiles(recording + "/depth.txt").at(index).path;
  }

  AppRun reconstruct(const std::string& input, std::vector<std::string> arguments = {},
                     const std::vector<std::string>& environment = {}) const {
    arguments.insert(arguments.end(), {"--input", input, "--output", out()});
    return runApp("reconstruct", arguments, environment);
  }

  void expectResults(size_t frames) const {
    EXPECT_EQ(readTrajectory(out() + "/trajectory.txt").size(), frames);
    EXPECT_EQ(readReport(out())["frames"]["tracked"], frames);
    EXPECT_GT(readPly(out() + "/mesh.ply").triangles.size(), 10000u);
  }

  inline static std::unique_ptr<TemporaryFolder> suite_folder_;
  TemporaryFolder folder_;
};

TEST_F(BadInput, missing_folder) {
  expectComplaint(reconstruct(folder_ / "nothing"),
                  {"reconstruct: ", folder_ / "nothing", "no such folder", "check"});
}

TEST_F(BadInput, empty_folder) {
  fs::create_directory(folder_ / "empty");
  expectComplaint(reconstruct(folder_ / "empty"), {folder_ / "empty", "is empty", "layout"});
}

TEST_F(BadInput, truncated_depth_image_is_named_and_the_rest_fused) {
  const std::string image = depthImage(roomCopy(), 3);
  fs::resize_file(image, fs::file_size(image) / 2);
  expectComplaint(reconstruct(folder_ / "room"), {image, "truncated", "again"});
  expectResults(kFrames - 1);
  EXPECT_EQ(readReport(out())["frames"]["unreadable"], 1);
}

TEST_F(BadInput, damaged_colour_is_said_once_and_costs_no_frame) {
  const std::string recording = roomCopy();
  for (const size_t index : {1, 3, 4}) {
    const std::string image = readTimedFiles(recording + "/rgb.txt").at(index).path;
    fs::resize_file(image, fs::file_size(image) / 2);
  }
  const AppRun run = reconstruct(recording, {"--color", "--voxel-size", "0.01"});
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(std::count(run.errors.begin(), run.errors.end(), '\n'), 1) << run.errors;
  EXPECT_NE(run.errors.find("truncated"), std::string::npos) << run.errors;
  EXPECT_EQ(readReport(out())["frames"]["tracked"], kFrames);
  EXPECT_EQ(readReport(out())["frames"]["colored"], kFrames - 3);
}

TEST_F(BadInput, colour_asked_for_but_not_recorded) {
  const std::string recording = roomCopy();
  fs::remove(recording + "/rgb.txt");
  expectComplaint(reconstruct(recording, {"--color"}), {"--color", recording, "no frame"});
  expectResults(kFrames);
}

TEST_F(BadInput, depth_image_of_another_size_is_named_and_the_rest_fused) {
  const std::string image = depthImage(roomCopy(), 2);
  writePng(image, cv::Mat(240, 320, CV_16UC1, cv::Scalar(5000)));
  expectComplaint(reconstruct(folder_ / "room", {"--intrinsics", "525,525,319.5,239.5"}),
                  {image, "320x240", "640x480", "--intrinsics"});
  expectResults(kFrames - 1);
}

TEST_F(BadInput, camera_file_of_another_size) {
  const std::string recording = roomCopy();
  writeCameraFile(recording + "/camera.yaml", {{320, 240, 262.5, 262.5, 159.5, 119.5}, 5000.0, {}, {}});
  expectComplaint(reconstruct(recording), {recording, "camera.yaml", "320x240", "640x480", "--intrinsics"});
}

TEST_F(BadInput, blank_frame_is_lost_and_the_rest_fused) {
  const std::string recording = roomCopy();
  writePng(depthImage(recording, 2), cv::Mat::zeros(480, 640, CV_16UC1));
  const AppRun run = reconstruct(recording);
  EXPECT_EQ(run.status, 0) << run.errors;
  expectResults(kFrames - 1);
  EXPECT_EQ(readReport(out())["frames"]["lost"], 1);
}

TEST_F(BadInput, blank_first_frame_does_not_end_tracking) {
  const std::string recording = roomCopy();
  writePng(depthImage(recording, 0), cv::Mat::zeros(480, 640, CV_16UC1));
  const AppRun run = reconstruct(recording);
  EXPECT_EQ(run.status, 0) << run.errors;
  expectResults(kFrames - 1);
}

TEST_F(BadInput, bag_without_depth) {
  const std::string path = folder_ / "colour.bag";
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  addToBag(bag, "/camera/rgb/image_raw", 1.0, imageMessage(cv::Mat::zeros(48, 64, CV_8UC3), "bgr8"));
  bag.close();
  expectComplaint(reconstruct(path), {path, "no depth topic", "/camera/rgb/image_raw", "--depth-topic"});
}

TEST_F(BadInput, bag_without_camera_info) {
  const std::string path = folder_ / "depth.bag";
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  addToBag(bag, "/camera/depth/image_raw", 1.0, imageMessage(cv::Mat::zeros(48, 64, CV_16UC1), "16UC1"));
  bag.close();
  expectComplaint(reconstruct(path), {path, "no camera_info", "/camera/depth/image_raw", "--intrinsics"});
}

TEST_F(BadInput, bag_cut_short) {
  const std::string path = folder_ / "room.bag";
  ASSERT_EQ(runApp("simulate", {"--output", path, "--frames", "2"}).status, 0);
  fs::resize_file(path, fs::file_size(path) / 2);
  expectComplaint(reconstruct(path), {path, "index", "rosbag reindex"});
}

TEST_F(BadInput, unknown_parameter) {
  writeText(folder_ / "parameters.yaml", "map: {voxel_size: 0.01}\n");
  expectComplaint(reconstruct(room(), {"--params", folder_ / "parameters.yaml"}),
                  {folder_ / "parameters.yaml", "map/voxel_size", "map/voxel_size_m"});
}

TEST_F(BadInput, missing_parameter_file) {
  expectComplaint(reconstruct(room(), {"--params", folder_ / "none.yaml"}),
                  {folder_ / "none.yaml", "check the path"});
}

TEST_F(BadInput, parameter_out_of_range) {
  expectComplaint(reconstruct(room(), {"--voxel-size", "-0.01"}),
                  {"map/voxel_size_m", "-0.01", "must lie in"});
}

TEST_F(BadInput, map_that_the_device_cannot_hold) {
  // PoCL then reports 4 GB, whatever the machine has; the offsets alone would take 8.4.
  expectComplaint(reconstruct(room(), {"--blocks-per-axis", "1280"}, {"POCL_MEMORY_LIMIT=4"}),
                  {"map/blocks_per_axis"});
}

TEST_F(BadInput, unknown_device) {
  expectComplaint(reconstruct(room(), {"--device", "abacus"}), {"device", "abacus", "--device list"});
}

TEST_F(BadInput, no_device) {
  expectComplaint(reconstruct(room(), {}, {"OCL_ICD_VENDORS=/nonexistent"}),
                  {"no OpenCL device", "pocl-opencl-icd"});
}

TEST_F(BadInput, unreadable_trajectory) {
  expectComplaint(reconstruct(room(), {"--trajectory", folder_ / "poses.txt"}),
                  {folder_ / "poses.txt", "read"});
}

TEST_F(BadInput, trajectory_of_another_time) {
  writeText(folder_ / "poses.txt", "1000.0 0 0 0 0 0 0 1\n1001.0 0 0 0 0 0 0 1\n");
  expectComplaint(reconstruct(room(), {"--trajectory", folder_ / "poses.txt"}),
                  {"no frame", room(), folder_ / "poses.txt"});
}

TEST_F(BadInput, full_pool_fuses_what_fits) {
  writeText(folder_ / "parameters.yaml", "map: {pool_mib: 8}\n");
  expectComplaint(reconstruct(room(), {"--params", folder_ / "parameters.yaml"}),
                  {"pool is full", "frame", "map/pool_mib", "--voxel-size"});
  EXPECT_GE(readTrajectory(out() + "/trajectory.txt").size(), 1u);
  EXPECT_GT(readPly(out() + "/mesh.ply").triangles.size(), 10000u);
  const nlohmann::json map = readReport(out())["map"];
  EXPECT_GT(map["blocks"].get<double>(), 0.9 * map["capacity"].get<double>());
}

TEST_F(BadInput, unwritable_output) {
  writeText(out(), "a file where the folder should be");
  expectComplaint(reconstruct(room()), {out(), "cannot be written", "--output"});
}

TEST_F(BadInput, one_file_that_cannot_be_written_leaves_the_others) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  for (const std::string file : {"mesh.ply", "trajectory.txt", "report.json"}) {
    fs::remove_all(out());
    fs::create_directory(out());
    fs::create_symlink("/dev/full", out() + "/" + file);
    expectComplaint(reconstruct(room(), {"--max-frames", "2"}), {out() + "/" + file, "No space left"});
    for (const std::string other : {"mesh.ply", "trajectory.txt", "report.json"}) {
      if (other == file) continue;
      EXPECT_GT(fs::file_size(out() + "/" + other), 100u) << other;
    }
  }
}

// A file system of 4 MiB, for as long as the object lives.
class SmallDisk {
 public:
  explicit SmallDisk(const std::string& path) : path_(path) {
    fs::create_directory(path);
    mounted_ = mount("tmpfs", path.c_str(), "tmpfs", 0, "size=4m") == 0;
  }
  ~SmallDisk() {
    if (mounted_) umount(path_.c_str());
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  bool mounted() const { return mounted_; }

 private:
  std::string path_;
  bool mounted_ = false;
};

TEST_F(BadInput, full_disk) {
  const SmallDisk disk(out());
  if (!disk.mounted()) GTEST_SKIP() << "mounting a small file system needs root";
  expectComplaint(reconstruct(room()), {out() + "/mesh.ply", "No space left"});
  EXPECT_FALSE(fs::exists(out() + "/mesh.ply"));
  EXPECT_EQ(readTrajectory(out() + "/trajectory.txt").size(), static_cast<size_t>(kFrames));
  EXPECT_EQ(readReport(out())["frames"]["tracked"], kFrames);
}

TEST_F(BadInput, simulate_onto_a_full_disk) {
  const SmallDisk disk(folder_ / "disk");
  if (!disk.mounted()) GTEST_SKIP() << "mounting a small file system needs root";
  for (const std::string name : {"disk/recording", "disk/recording.bag"}) {
    expectComplaint(runApp("simulate", {"--output", folder_ / name, "--frames", "20"}),
                    {"simulate: ", folder_ / name});
  }
}

TEST_F(BadInput, other_apps) {
  expectComplaint(runApp("evaluate", {"--trajectory", folder_ / "a.txt", "--groundtruth", folder_ / "b.txt"}),
                  {"evaluate: ", folder_ / "b.txt", "read"});
  expectComplaint(runApp("evaluate", {"--mesh", folder_ / "a.ply", "--scene", "castle"}),
                  {"castle", "room, object"});
  expectComplaint(runApp("render", {"--mesh", folder_ / "a.ply"}), {"render: ", folder_ / "a.ply"});
  expectComplaint(runApp("simulate", {"--output", folder_ / "a", "--scene", "castle"}),
                  {"castle", "room, object"});
}

}  // namespace
}  // namespace depth_fusion
