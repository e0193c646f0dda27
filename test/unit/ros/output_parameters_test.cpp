// Every member of the output's parameters has a row.
#include <gtest/gtest.h>

#include "ros/output/live_surface.h"
#include "ros/output/model_picture.h"
#include "ros/output/pose_publisher.h"
#include "support/parameter_rows.h"

namespace depth_fusion {
namespace {

TEST(ParameterRows, EveryMemberOfTheOutputsHasOne) {
  expectRows<PoseParameters>();
  expectRows<LiveSurfaceParameters>();
  expectRows<ModelPictureParameters>();
}

}  // namespace
}  // namespace depth_fusion
