#include "ros/input/player_parameters.h"

namespace depth_fusion {

ParameterTable PlayerParameters::table() {
  return atStartOnly(
      {{"recording", &recording, 0, 0, "a folder in the TUM or 7-Scenes layout, or a .bag or .oni file"},
       {"camera_file", &camera_file, 0, 0,
        "camera file in place of the recording's; lens distortion is taken out"},
       {"depth_topic", &options.depth_topic, 0, 0, "of a bag, instead of the one found"},
       {"color_topic", &options.color_topic, 0, 0, "of a bag, instead of the one found"},
       {"device", &device, 0, 0,
        "OpenCL device, as of icp_tracking; opened where depth is to be moved or a lens undistorted"},
       {"frame_id", &frame_id, 0, 0, "optical frame of a recording's images"},
       {"rate", &rate, 0.01, 100.0, "factor on the recording's speed"},
       {"loop", &loop, 0, 1, "begin again at the end; the clock then jumps back"},
       {"restamp", &restamp, 0, 1, "stamps of now, as a sensor's; false: the recording's"},
       {"publish_clock", &publish_clock, 0, 1, "publish the stamps on /clock; for use_sim_time"},
       {"lossless", &lossless, 0, 1, "the next frame waits until the one before is in the map, or lost"},
       {"lossless_timeout_s", &lossless_timeout_s, 0.1, 3600.0, "how long it waits at most"},
       {"settle_s", &settle_s, 0.0, 60.0, "begin when no subscriber has come or gone for so long"}});
}

}  // namespace depth_fusion
