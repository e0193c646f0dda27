// Every member of the parameters of input and output has a row.
#include <gtest/gtest.h>

#include "ros/input/device_publisher_parameters.h"
#include "ros/input/rgbd_parameters.h"
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

TEST(ParameterRows, EveryMemberOfTheInputsHasOne) {
  expectRows<DeviceTimeParameters>();
  // Its own members, those of the pairing, and none of the registration, which has a table of its own.
  expectRows<RgbdParameters>(fieldCount<RgbdParameters>() - 2 + fieldCount<PairingParameters>());
}

}  // namespace
}  // namespace depth_fusion
