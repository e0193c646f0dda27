#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "common/io/text_file.h"
#include "depth_fusion/recording/recording.h"
#include "depth_fusion/recording/recording_writer.h"
#include "support/expect_error.h"
#include "support/real_data.h"
#include "support/temporary_folder.h"
#include "support/test_frames.h"

namespace depth_fusion {
namespace {

namespace fs = std::filesystem;

// Three depth images of 640x480 in a folder as the benchmark ships them, without intrinsics.
void makeBenchmarkFolder(const TemporaryFolder& folder, const cv::Size& size = {640, 480}) {
  fs::create_directories(folder / "depth");
  for (int i = 1; i <= 3; ++i) {
    cv::imwrite(folder / ("depth/" + std::to_string(i) + ".png"),
                cv::Mat(size, CV_16UC1, cv::Scalar(1000 * i)));
  }
  writeText(folder / "depth.txt", "# list\n3.0 depth/3.png\n1.0 depth/1.png\n2.0 depth/2.png\n");
}

void writeFrames(const std::string& path, int count) {
  const auto writer = createTumFolder(path);
  for (int i = 0; i < count; ++i) writer->write(testFrame(i));
  writer->finish();
}

void truncateFile(const std::string& path, double fraction) {
  fs::resize_file(path, static_cast<uintmax_t>(fraction * static_cast<double>(fs::file_size(path))));
}

std::string onlyFileIn(const std::string& folder) { return fs::directory_iterator(folder)->path().string(); }

TEST(TumRecording, reads_back_what_was_written) {
  const TemporaryFolder folder;
  writeFrames(folder / "room", 3);
  const auto recording = openFolder(folder / "room", {});
  EXPECT_EQ(recording->frameCount(), 3u);
  for (int i = 0; i < 3; ++i) {
    const RgbdFrame written = testFrame(i);
    const auto read = recording->next();
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(read->stamp_s, written.stamp_s);
    EXPECT_DOUBLE_EQ(read->depth_unit_m, written.depth_unit_m);
    EXPECT_TRUE(sameImage(read->depth, written.depth));
    EXPECT_TRUE(sameImage(read->color, written.color));
    expectSameIntrinsics(read->intrinsics, written.intrinsics);
    EXPECT_FALSE(read->T_W_D.has_value());
  }
  EXPECT_FALSE(recording->next().has_value());
  EXPECT_FALSE(recording->next().has_value());
}

TEST(TumRecording, sorts_the_list_and_uses_the_benchmarks_intrinsics) {
  const TemporaryFolder folder;
  makeBenchmarkFolder(folder);
  const auto recording = openFolder(folder.path(), {});
  for (int i = 1; i <= 3; ++i) {
    const auto frame = recording->next();
    ASSERT_TRUE(frame.has_value());
    EXPECT_EQ(frame->stamp_s, i);
    EXPECT_EQ(frame->depth.at<uint16_t>(10, 10), 1000 * i);
    EXPECT_DOUBLE_EQ(frame->depth_unit_m, 0.0002);
    EXPECT_TRUE(frame->color.empty());
    expectSameIntrinsics(frame->intrinsics, {640, 480, 525.0, 525.0, 319.5, 239.5});
  }
  EXPECT_NE(recording->description().find("benchmark's default"), std::string::npos);
}

TEST(TumRecording, pairs_each_depth_with_the_nearest_colour) {
  const TemporaryFolder folder;
  makeBenchmarkFolder(folder);
  fs::create_directories(folder / "rgb");
  const auto addColor = [&](const std::string& name, int gray) {
    cv::imwrite(folder / ("rgb/" + name), cv::Mat(480, 640, CV_8UC1, cv::Scalar(gray)));
  };
  addColor("a.png", 10);
  addColor("b.png", 20);
  addColor("c.png", 30);
  writeText(folder / "rgb.txt", "2.03 rgb/c.png\n0.99 rgb/a.png\n1.005 rgb/b.png\n");
  RecordingOptions options;
  options.max_pairing_gap_s = 0.02;
  auto recording = openFolder(folder.path(), options);
  EXPECT_EQ(recording->next()->color.at<uint8_t>(0, 0), 20);
  EXPECT_TRUE(recording->next()->color.empty());
  EXPECT_TRUE(recording->next()->color.empty());
  options.max_pairing_gap_s = 1.0;
  recording = openFolder(folder.path(), options);
  recording->next();
  EXPECT_EQ(recording->next()->color.at<uint8_t>(0, 0), 30);
  EXPECT_EQ(recording->next()->color.at<uint8_t>(0, 0), 30) << "one colour may serve two depths";
}

TEST(TumRecording, given_intrinsics_replace_the_recordings) {
  const TemporaryFolder folder;
  makeBenchmarkFolder(folder);
  RecordingOptions options;
  options.intrinsics = CameraIntrinsics{0, 0, 517.3, 516.5, 318.6, 255.3};
  expectSameIntrinsics(openFolder(folder.path(), options)->next()->intrinsics,
                       {640, 480, 517.3, 516.5, 318.6, 255.3});
  options.intrinsics = CameraIntrinsics{320, 240, 517.3, 516.5, 318.6, 255.3};
  expectError([&] { openFolder(folder.path(), options); },
              {folder.path(), "640x480", "320x240", "--intrinsics"});
  options.intrinsics = CameraIntrinsics{0, 0, 0.0, 516.5, 318.6, 255.3};
  expectError([&] { openFolder(folder.path(), options); }, {folder.path(), "not valid", "--intrinsics"});
}

TEST(TumRecording, asks_for_the_intrinsics_of_another_size) {
  const TemporaryFolder folder;
  makeBenchmarkFolder(folder, {320, 240});
  expectError([&] { openFolder(folder.path(), {}); }, {folder.path(), "320x240", "--intrinsics"});
}

TEST(TumRecording, camera_file_gives_scale_and_is_checked) {
  const TemporaryFolder folder;
  makeBenchmarkFolder(folder);
  const std::string camera = "width: 640\nheight: 480\nfx: 500\nfy: 501\ncx: 320\ncy: 240\n";
  writeText(folder / "camera.yaml", camera + "depth_scale: 1000\n");
  EXPECT_DOUBLE_EQ(openFolder(folder.path(), {})->next()->depth_unit_m, 0.001);
  const auto expectBad = [&](const std::string& text, const std::string& word) {
    writeText(folder / "camera.yaml", text);
    expectError([&] { openFolder(folder.path(), {}); }, {folder / "camera.yaml", word});
  };
  expectBad(camera + "depth_scael: 1000\n", "depth_scael");
  expectBad(camera + "depth_scale: 0\n", "depth_scale");
  expectBad("width: 640\nheight: 480\nfx: 500\nfy: 501\ncx: 320\n", "'cy' is missing");
  expectBad("width: wide\n", "'width' is not a number");
  expectBad("just text\n", "key: number");
}

TEST(TumRecording, goes_on_after_a_damaged_image) {
  const TemporaryFolder folder;
  for (const double fraction : {0.0, 0.5, 0.9}) {
    const std::string path = folder / std::to_string(fraction);
    writeFrames(path, 3);
    const std::string damaged = path + "/depth/" + stampText(testFrame(1).stamp_s) + ".png";
    truncateFile(damaged, fraction);
    const auto recording = openFolder(path, {});
    EXPECT_EQ(recording->next()->stamp_s, testFrame(0).stamp_s);
    expectError([&] { recording->next(); }, {damaged, fraction == 0.0 ? "empty" : "truncated"});
    EXPECT_EQ(recording->next()->stamp_s, testFrame(2).stamp_s);
    EXPECT_FALSE(recording->next().has_value());
  }
}

TEST(TumRecording, notices_every_truncation_of_an_image) {
  const TemporaryFolder folder;
  const std::string path = folder / "room";
  writeFrames(path, 1);
  const std::string depth_path = onlyFileIn(path + "/depth");
  const auto recordingIsWhole = [&] {
    try {
      return openFolder(path, {})->next().has_value();
    } catch (const Error&) {
      return false;
    }
  };
  ASSERT_TRUE(recordingIsWhole());
  for (auto size = fs::file_size(depth_path); size-- > 0;) {
    fs::resize_file(depth_path, size);
    EXPECT_FALSE(recordingIsWhole()) << "cut to " << size << " bytes";
  }
}

TEST(TumRecording, notices_damage_inside_an_image) {
  const TemporaryFolder folder;
  const std::string path = folder / "room";
  writeFrames(path, 1);
  const std::string depth_path = onlyFileIn(path + "/depth");
  std::fstream file(depth_path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(static_cast<std::streamoff>(fs::file_size(depth_path) / 2));
  file.write("\x55\xaa\x55\xaa", 4);
  file.close();
  expectError([&] { openFolder(path, {})->next(); }, {depth_path, "corrupt"});
}

TEST(TumRecording, truncated_colour_costs_no_depth) {
  const TemporaryFolder folder;
  makeBenchmarkFolder(folder);
  cv::imwrite(folder / "1.jpg", randomColor(1));
  writeText(folder / "rgb.txt", "1.0 1.jpg\n");
  EXPECT_EQ(openFolder(folder.path(), {})->next()->color.type(), CV_8UC3);
  truncateFile(folder / "1.jpg", 0.9);
  const auto frame = openFolder(folder.path(), {})->next();
  EXPECT_FALSE(frame->depth.empty());
  EXPECT_TRUE(frame->color.empty());
  EXPECT_NE(frame->color_problem.find("truncated"), std::string::npos) << frame->color_problem;
  EXPECT_NE(frame->color_problem.find(folder / "1.jpg"), std::string::npos) << frame->color_problem;
}

TEST(TumRecording, names_images_that_are_missing_or_of_another_kind) {
  const TemporaryFolder folder;
  makeBenchmarkFolder(folder);
  fs::remove(folder / "depth/1.png");
  cv::imwrite(folder / "depth/2.png", cv::Mat(480, 640, CV_8UC3, cv::Scalar::all(1)));
  cv::imwrite(folder / "depth/3.png", cv::Mat(240, 320, CV_16UC1, cv::Scalar(1)));
  const auto recording = openFolder(folder.path(), {});
  expectError([&] { recording->next(); }, {folder / "depth/1.png", "No such file"});
  expectError([&] { recording->next(); }, {folder / "depth/2.png", "16 bits", "3 of 8"});
  expectError([&] { recording->next(); }, {folder / "depth/3.png", "320x240", "640x480"});
  EXPECT_FALSE(recording->next().has_value());
}

TEST(TumRecording, names_what_is_wrong_with_the_folder) {
  const TemporaryFolder folder;
  expectError([&] { openFolder(folder / "missing", {}); }, {folder / "missing", "no such folder"});
  expectError([&] { openFolder(folder.path(), {}); }, {folder.path(), "empty"});
  writeText(folder / "notes.txt", "hello\n");
  expectError([&] { openFolder(folder.path(), {}); }, {folder.path(), "depth.txt", "7-Scenes"});
  expectError([&] { openFolder(folder / "notes.txt", {}); }, {folder / "notes.txt", "no recording"});
}

TEST(TumRecording, names_what_is_wrong_with_the_lists) {
  const TemporaryFolder folder;
  const auto expectBadList = [&](const std::string& text, const std::vector<std::string>& words) {
    writeText(folder / "depth.txt", text);
    expectError([&] { openFolder(folder.path(), {}); }, words);
  };
  expectBadList("# nothing\n", {folder / "depth.txt", "lists no file"});
  expectBadList("# a\n1.0 a.png\nsoon b.png\n",
                {(folder / "depth.txt") + ":3: ", "soon b.png", "stamp file"});
  expectBadList("1.0\n", {(folder / "depth.txt") + ":1: "});
  expectBadList("nan a.png\n", {(folder / "depth.txt") + ":1: "});
  expectBadList("1.0 a.png\n2.0 b.png\n", {folder / "depth.txt", "none of its 2 files", folder / "a.png"});
  makeBenchmarkFolder(folder);
  writeText(folder / "rgb.txt", "\n");
  const auto recording = openFolder(folder.path(), {});
  EXPECT_NE(recording->description().find("colour is left out: " + (folder / "rgb.txt") + ": lists no file"),
            std::string::npos)
      << recording->description();
  EXPECT_FALSE(recording->next()->depth.empty());
}

TEST(TumRecording, reads_the_real_freiburg1_xyz) {
  const std::string path = realDataFolder("tum_fr1_xyz");
  if (!fs::exists(path)) GTEST_SKIP() << path << " is not there";
  const auto recording = openFolder(path, {});
  EXPECT_EQ(recording->frameCount(), 500u);
  int colored = 0;
  int count = 0;
  double last_stamp_s = 0.0;
  while (const auto frame = recording->next()) {
    ++count;
    colored += frame->color.size() == cv::Size(640, 480) && frame->color.type() == CV_8UC3 ? 1 : 0;
    EXPECT_GT(frame->stamp_s, last_stamp_s);
    last_stamp_s = frame->stamp_s;
    expectSameIntrinsics(frame->intrinsics, {640, 480, 525.0, 525.0, 319.5, 239.5});
    const double mean_m = cv::mean(frame->depth, frame->depth > 0)[0] * frame->depth_unit_m;
    EXPECT_GT(mean_m, 0.5);
    EXPECT_LT(mean_m, 3.0);
  }
  EXPECT_EQ(count, 500);
  EXPECT_GE(colored, 480);
}

}  // namespace
}  // namespace depth_fusion
