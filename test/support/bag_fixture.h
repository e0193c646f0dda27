// Small bags for tests of what reads them.
#pragma once

#include <gtest/gtest.h>

#include <functional>

#include "support/bag_messages.h"
#include "support/temporary_folder.h"
#include "support/test_frames.h"

namespace depth_fusion {

constexpr char kDepthTopic[] = "/camera/depth/image_raw";
constexpr char kDepthInfo[] = "/camera/depth/camera_info";
constexpr char kColorTopic[] = "/camera/rgb/image_raw";

// Makes bags in a folder of its own.
class BagTest : public ::testing::Test {
 protected:
  std::string makeBag(const std::function<void(rosbag::Bag&)>& fill) {
    const std::string path = folder_ / ("bag" + std::to_string(bag_count_++) + ".bag");
    rosbag::Bag bag(path, rosbag::bagmode::Write);
    fill(bag);
    bag.close();
    return path;
  }

  TemporaryFolder folder_;
  int bag_count_ = 0;
};

inline void addInfo(rosbag::Bag& bag, const std::string& topic = kDepthInfo) {
  addToBag(bag, topic, 1.0, infoMessage(kTestWidth, kTestHeight, 10.0));
}

inline void addDepth(rosbag::Bag& bag, double stamp_s, double delay_s = 0.0) {
  addToBag(bag, kDepthTopic, stamp_s, imageMessage(randomDepth(static_cast<int>(stamp_s * 100.0)), "16UC1"),
           delay_s);
}

inline void addGray(rosbag::Bag& bag, double stamp_s, int gray, double delay_s = 0.0) {
  const cv::Mat color(kTestHeight, kTestWidth, CV_8UC1, cv::Scalar(gray));
  addToBag(bag, kColorTopic, stamp_s, imageMessage(color, "mono8"), delay_s);
}

}  // namespace depth_fusion
