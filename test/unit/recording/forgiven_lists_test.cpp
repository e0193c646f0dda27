// Lists by any editor and any tool give the same recording.
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "common/io/text_file.h"
#include "depth_fusion/recording/recording.h"
#include "recording/timed_files.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"
#include "support/test_frames.h"

namespace depth_fusion {
namespace {

namespace fs = std::filesystem;

std::string inUtf16(const std::string& text) {
  std::string bytes("\xff\xfe", 2);
  for (const char letter : text) bytes += {letter, '\0'};
  return bytes;
}

class ForgivenLists : public testing::Test {
 protected:
  ForgivenLists() {
    fs::create_directories(folder_ / "depth");
    fs::create_directories(folder_ / "rgb");
    for (int i = 1; i <= 2; ++i) {
      const std::string name = std::to_string(i) + ".png";
      cv::imwrite(folder_ / ("depth/" + name), randomDepth(i));
      cv::imwrite(folder_ / ("rgb/" + name), randomColor(i));
    }
    writeText(folder_ / "camera.yaml", "width: 12\nheight: 8\nfx: 10\nfy: 10\ncx: 5.5\ncy: 3.5\n");
  }

  // Both frames, with colour if that is expected.
  void expectBoth(const std::string& what, bool color) const {
    const auto recording = openFolder(folder_.path(), {});
    EXPECT_EQ(recording->frameCount(), 2u) << what;
    for (int i = 1; i <= 2; ++i) {
      const auto frame = recording->next();
      ASSERT_TRUE(frame.has_value()) << what;
      EXPECT_NEAR(frame->stamp_s, i, 1e-9) << what;
      EXPECT_TRUE(sameImage(frame->depth, randomDepth(i))) << what;
      EXPECT_EQ(color, sameImage(frame->color, randomColor(i))) << what;
    }
  }

  TemporaryFolder folder_;
};

TEST_F(ForgivenLists, depth_list_by_any_editor) {
  const std::string plain = "# stamp file\n1.0 depth/1.png\n2.0 depth/2.png\n";
  const std::string lists[] = {plain,
                               "\xef\xbb\xbf" + plain,
                               inUtf16(plain),
                               "1.0 depth/1.png\r\n2.0 depth/2.png  \t\r\n\r\n",
                               "1.0 depth/1.png\r2.0 depth/2.png\r",
                               "  1.0\tdepth/1.png # the first\n\n\t2.0\t\tdepth/2.png",
                               "timestamp,filename\n1.0,depth/1.png\n2.0,depth/2.png,\n",
                               "1.0; \"depth/1.png\"\n2.0; 'depth/2.png'\n",
                               "1.0 depth\\1.png\n2.0 depth\\2.png\n"};
  for (const std::string& list : lists) {
    writeText(folder_ / "depth.txt", list);
    expectBoth(list, false);
  }
}

TEST_F(ForgivenLists, stamps_with_decimal_commas) {
  writeText(folder_ / "depth.txt", "1,0 depth/1.png\n2,000000 depth/2.png\n");
  writeText(folder_ / "rgb.txt", "1,01\trgb/1.png\n1,99\trgb/2.png\n");
  expectBoth("two lists", true);
  fs::remove(folder_ / "depth.txt");
  fs::remove(folder_ / "rgb.txt");
  writeText(folder_ / "associations.txt", "1,0 depth/1.png 1,5 rgb/1.png\n2,0 depth/2.png 2,5 rgb/2.png\n");
  expectBoth("associations", true);
}

// The folder was moved since, or the names begin with its own.
TEST_F(ForgivenLists, names_that_lead_elsewhere_are_found_by_their_ends) {
  const std::string name = fs::path(folder_.path()).filename().string();
  for (const std::string& begin :
       {std::string("/home/somebody/data/"), std::string("C:\\data\\"), name + "/"}) {
    writeText(folder_ / "depth.txt", "1.0 " + begin + "depth/1.png\n2.0 " + begin + "depth/2.png\n");
    expectBoth(begin, false);
  }
  writeText(folder_ / "depth.txt", "1.0 depth/1.png\n2.0 /data/depth/3.png\n");
  const auto recording = openFolder(folder_.path(), {});
  EXPECT_TRUE(recording->next().has_value());
  expectError([&] { recording->next(); }, {"data/depth/3.png", "No such file"});
}

TEST_F(ForgivenLists, equal_stamps_are_said) {
  writeText(folder_ / "depth.txt", "1.0 depth/1.png\n1.0 depth/2.png\n");
  const std::string description = openFolder(folder_.path(), {})->description();
  EXPECT_NE(description.find("1 of the 2 images of " + (folder_ / "depth.txt")), std::string::npos)
      << description;
}

TEST_F(ForgivenLists, images_of_which_none_is_depth_are_named_at_once) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_16UC3}) {
    for (const char* name : {"depth/1.png", "depth/2.png"})
      cv::imwrite(folder_ / name, cv::Mat(8, 12, type, cv::Scalar::all(7)));
    writeText(folder_ / "depth.txt", "1.0 depth/1.png\n2.0 depth/2.png\n");
    expectError([&] { openFolder(folder_.path(), {}); }, {folder_ / "depth.txt", "16 bits", "depth/1.png"});
  }
  // Where one of them is, the others cost themselves.
  cv::imwrite(folder_ / "depth/2.png", randomDepth(2));
  const auto recording = openFolder(folder_.path(), {});
  expectError([&] { recording->next(); }, {"depth/1.png", "16 bits"});
  EXPECT_EQ(recording->next()->stamp_s, 2.0);
}

TEST_F(ForgivenLists, colour_of_another_clock_is_said) {
  std::string depth, color;
  for (int i = 1; i <= 8; ++i) {
    depth += std::to_string(i) + ".0 depth/1.png\n";
    color += std::to_string(1600000000 + i) + ".0 rgb/1.png\n";
  }
  writeText(folder_ / "depth.txt", depth);
  writeText(folder_ / "rgb.txt", color);
  const auto recording = openFolder(folder_.path(), {});
  std::string problem;
  for (int i = 1; i <= 8; ++i) {
    const auto frame = recording->next();
    EXPECT_FALSE(frame->depth.empty());
    EXPECT_TRUE(frame->color.empty());
    problem = frame->color_problem;
  }
  for (const char* word : {"20 ms", "1.6e+09 s later", "one clock"})
    EXPECT_NE(problem.find(word), std::string::npos) << problem;
}

// Every third depth image has colour.
TEST_F(ForgivenLists, colour_at_a_lower_rate_is_no_problem) {
  std::string depth;
  for (int i = 0; i < 30; ++i) depth += std::to_string(1.0 + 0.1 * i) + " depth/1.png\n";
  writeText(folder_ / "depth.txt", depth);
  writeText(folder_ / "rgb.txt", "1.0 rgb/1.png\n1.3 rgb/1.png\n1.6 rgb/1.png\n1.9 rgb/1.png\n");
  const auto recording = openFolder(folder_.path(), {});
  while (const auto frame = recording->next()) EXPECT_EQ(frame->color_problem, "");
}

TEST_F(ForgivenLists, names_with_blanks_and_hashes) {
  fs::rename(folder_ / "depth/1.png", folder_ / "depth/scan 1 of#2.png");
  writeText(folder_ / "depth.txt", "1.0 depth/scan 1 of#2.png\n2.0 depth/2.png\n");
  expectBoth("blanks", false);
}

TEST_F(ForgivenLists, lines_that_are_no_entries_are_left_out_and_said) {
  writeText(folder_ / "depth.txt", "1.0 depth/1.png\nsoon depth/1.png\n2.0 depth/2.png\nnan depth/2.png\n");
  expectBoth("a bad line", false);
  const std::string description = openFolder(folder_.path(), {})->description();
  EXPECT_NE(description.find("2 lines left out, the first: " + (folder_ / "depth.txt") + ":2"),
            std::string::npos)
      << description;
}

TEST_F(ForgivenLists, stamps_in_nanoseconds) {
  writeText(folder_ / "depth.txt", "1403636579750000000 depth/1.png\n1403636579800000000 depth/2.png\n");
  writeText(folder_ / "rgb.txt", "1403636579751000000,rgb/1.png\n1403636579801000000,rgb/2.png\n");
  const auto recording = openFolder(folder_.path(), {});
  for (int i = 1; i <= 2; ++i) {
    const auto frame = recording->next();
    EXPECT_NEAR(frame->stamp_s, 1403636579.70 + 0.05 * i, 1e-6);
    EXPECT_TRUE(sameImage(frame->color, randomColor(i)));
  }
}

TEST_F(ForgivenLists, associations_alone_in_either_order) {
  const std::pair<const char*, const char*> lists[] = {
      {"associations.txt", "1 depth/1.png 1.015 rgb/1.png\n2 depth/2.png 2.5 rgb/2.png\n"},
      {"associate.txt", "1.4 rgb/1.png 1.0 depth/1.png\n2.4 rgb/2.png 2.0 depth/2.png\n"},
      {"fr1_assoc.txt",
       "\xef\xbb\xbf# rgb first\r\n2,rgb/2.png,2,depth/2.png\r\n1,rgb/1.png,1,depth/1.png\r\n"}};
  for (const auto& [name, list] : lists) {
    writeText(folder_ / name, list);
    expectBoth(name, true);
    fs::remove(folder_ / name);
  }
}

TEST_F(ForgivenLists, associations_say_the_colour_of_a_depth_list) {
  writeText(folder_ / "depth.txt", "1.0 depth/1.png\n2.0 depth/2.png\n");
  writeText(folder_ / "associations.txt", "1 depth/1.png 1.015 rgb/1.png\n2 depth/2.png 1.985 rgb/2.png\n");
  expectBoth("both lists", true);
}

// The images tell, not the names.
TEST_F(ForgivenLists, associations_whose_names_say_nothing) {
  fs::rename(folder_ / "rgb", folder_ / "a");
  fs::rename(folder_ / "depth", folder_ / "b depth of 2");
  writeText(folder_ / "associations.txt", "1 a/1.png 1 b depth of 2/1.png\n2 a/2.png 2 b depth of 2/2.png\n");
  expectBoth("a, b", true);
}

TEST_F(ForgivenLists, colour_lists_that_are_none_cost_no_depth) {
  writeText(folder_ / "depth.txt", "1.0 depth/1.png\n2.0 depth/2.png\n");
  for (const char* list : {"", "soon rgb/1.png\n", "1.0\n2.0\n"}) {
    writeText(folder_ / "rgb.txt", list);
    expectBoth(list, false);
    const std::string description = openFolder(folder_.path(), {})->description();
    EXPECT_NE(description.find("colour is left out"), std::string::npos) << description;
  }
  fs::remove(folder_ / "rgb.txt");
  fs::create_directory(folder_ / "rgb.txt");
  expectBoth("a folder", false);
}

TEST_F(ForgivenLists, a_first_image_of_another_size_costs_itself_only) {
  cv::imwrite(folder_ / "depth/0.png", cv::Mat(4, 4, CV_16UC1, cv::Scalar(7)));
  writeText(folder_ / "depth.txt", "0.5 depth/0.png\n1.0 depth/1.png\n2.0 depth/2.png\n");
  const auto recording = openFolder(folder_.path(), {});
  expectError([&] { recording->next(); }, {"depth/0.png", "4x4", "12x8"});
  EXPECT_EQ(recording->next()->stamp_s, 1.0);
}

}  // namespace
}  // namespace depth_fusion
