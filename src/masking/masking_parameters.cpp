#include "depth_fusion/masking/masking_parameters.h"

namespace depth_fusion {

ParameterTable MaskingParameters::table() {
  return {
      text("body", &body,
           "solids of the robot that are cut out of depth: FRAME box X Y Z LENGTH WIDTH HEIGHT; FRAME sphere "
           "X Y Z RADIUS; FRAME cylinder X Y Z RADIUS LENGTH; ... in metres, X Y Z being the middle in a "
           "frame on tf; empty: none"),
      atStartOnly(text("robot_description", &robot_description,
                       "name of a parameter with a URDF whose collision geometry (visual, where a link has "
                       "none) is cut out, too, each link where tf has it; empty: none")),
      number("padding_m", &padding_m, 0.0, 1.0,
             "by which solids are larger, for what depth and tf are off by"),
      number("max_wait_s", &max_wait_s, 0.0, 10.0,
             "how long a depth image waits for its mask, and for tf to have the robot's links")};
}

}  // namespace depth_fusion
