#include "ros/input/player_parameters.h"

namespace depth_fusion {

ParameterTable PlayerParameters::table() {
  return atStartOnly(
      {text("recording", &recording, "a folder in the TUM or 7-Scenes layout, or a .bag or .oni file"),
       text("camera_file", &camera_file,
            "camera file in place of the recording's; lens distortion is taken out"),
       text("depth_topic", &depth_topic, "of a bag, instead of the one found"),
       text("color_topic", &color_topic, "of a bag, instead of the one found"),
       text("device", &device,
            "OpenCL device, as of icp_tracking; opened where depth is to be moved or a lens undistorted"),
       text("frame_id", &frame_id, "optical frame of a recording's images"),
       number("rate", &rate, 0.01, 100.0, "factor on the recording's speed"),
       flag("loop", &loop, "begin again at the end; the clock then jumps back"),
       flag("restamp", &restamp, "stamps of now, as a sensor's; false: the recording's"),
       flag("publish_clock", &publish_clock, "publish the stamps on /clock; for use_sim_time"),
       flag("lossless", &lossless, "the next frame waits until the one before is in the map, or lost"),
       number("lossless_timeout_s", &lossless_timeout_s, 0.1, 3600.0, "how long it waits at most"),
       number("settle_s", &settle_s, 0.0, 60.0, "begin when no subscriber has come or gone for so long")});
}

}  // namespace depth_fusion
