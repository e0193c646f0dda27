#include "ros/input/rgbd_parameters.h"

namespace depth_fusion {

ParameterTable RgbdParameters::table() {
  return {
      {"depth_transport",
       &depth_transport,
       0,
       0,
       "of depth/image",
       {"raw", "compressedDepth", "compressed"},
       true},
      {"color_transport", &color_transport, 0, 0, "of rgb/image", {"raw", "compressed"}, true},
      {"max_pairing_gap_s", &pairing.max_gap_s, 0.0, 1.0,
       "colour farther from its depth than this is left out"},
      {"max_color_wait_s", &pairing.max_wait_s, 0.0, 10.0, "how long a depth image waits for its colour"}};
}

}  // namespace depth_fusion
