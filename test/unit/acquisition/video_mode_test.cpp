#include "acquisition/video_mode.h"

#include <gtest/gtest.h>

#include "support/expect_error.h"

namespace depth_fusion {
namespace {

void expectMode(const std::string& text, int width, int height, int fps) {
  const VideoMode mode = parseVideoMode(text, "depth_mode");
  EXPECT_EQ(mode.width, width) << text;
  EXPECT_EQ(mode.height, height) << text;
  EXPECT_EQ(mode.fps, fps) << text;
}

TEST(VideoMode, IsReadAsWritten) {
  expectMode("640x480@30", 640, 480, 30);
  expectMode("1280x1024@15", 1280, 1024, 15);
  expectMode("320x240", 320, 240, 0);
}

TEST(VideoMode, TextReadsBackAsTheSame) {
  for (const std::string text : {"640x480@30", "320x240"})
    EXPECT_EQ(videoModeText(parseVideoMode(text, "depth_mode")), text);
}

TEST(VideoMode, OtherTextIsRefusedByTheParametersName) {
  for (const std::string text :
       {"", "VGA", "640", "640x", "x480", "640x480@", "640x480@30Hz", " 640x480", "640x480 ", "640*480@30",
        "-640x480@30", "640x480@29.97", "999999999999x480"})
    expectError([&] { parseVideoMode(text, "color_mode"); }, {"color_mode", "'" + text + "'", "640x480@30"});
}

}  // namespace
}  // namespace depth_fusion
