#include "depth_fusion/geometry/camera_check.h"

#include <gtest/gtest.h>

#include <limits>

namespace depth_fusion {
namespace {

TEST(CameraCheck, takes_cameras_as_they_are) {
  for (const CameraIntrinsics& camera : {CameraIntrinsics{640, 480, 525.0, 525.0, 319.5, 239.5},
                                         CameraIntrinsics{640, 480, 481.2, -480.0, 319.5, 239.5},
                                         CameraIntrinsics{1024, 1024, 505.0, 505.0, 512.0, 512.0},
                                         CameraIntrinsics{640, 480, 2500.0, 2500.0, 100.0, 400.0}})
    EXPECT_EQ(cameraProblem(camera), "");
}

TEST(CameraCheck, names_what_cannot_be) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::pair<CameraIntrinsics, const char*> cameras[] = {
      {{640, 480, 1.0, 1.0, 0.0, 0.0}, "1 and 1 pixels are none for a 640x480"},
      {{640, 480, 525.0, 0.0, 319.5, 239.5}, "525 and 0"},
      {{640, 480, -525.0, 525.0, 319.5, 239.5}, "-525"},
      {{640, 480, 525.0, nan, 319.5, 239.5}, "no number"},
      {{640, 480, 525.0, 525.0, nan, 239.5}, "no number"},
      {{320, 240, 525.0, 525.0, 319.5, 239.5}, "(319.5, 239.5) is not within the 320x240"},
      {{640, 480, 525.0, 525.0, -1.0, 239.5}, "not within"},
      {{0, 480, 525.0, 525.0, 319.5, 239.5}, "0x480"}};
  for (const auto& [camera, words] : cameras)
    EXPECT_NE(cameraProblem(camera).find(words), std::string::npos) << cameraProblem(camera);
}

}  // namespace
}  // namespace depth_fusion
