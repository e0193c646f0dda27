#include "ros/input/rgbd_parameters.h"

namespace depth_fusion {

ParameterTable RgbdParameters::table() {
  return {
      atStartOnly(choice("depth_transport", &depth_transport,
                         {"auto", "raw", "compressedDepth", "compressed"},
                         "of depth/image; auto: raw, or a compressed one where only that is published")),
      atStartOnly(choice("color_transport", &color_transport, {"auto", "raw", "compressed"}, "of rgb/image")),
      number("max_pairing_gap_s", &pairing.max_gap_s, 0.0, 1.0,
             "colour farther from its depth than this is left out"),
      number("max_color_wait_s", &pairing.max_wait_s, 0.0, 10.0,
             "how long a depth image waits for its colour")};
}

}  // namespace depth_fusion
