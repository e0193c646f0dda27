#include "ros/in_process/live_tracker_parameters.h"

#include "ros/parameters/shared_rows.h"

namespace depth_fusion {

ParameterTable LiveTrackerParameters::table() {
  return {
      deviceRow(device),
      atStartOnly(flag("texture_odometry", &use_texture,
                       "true: frames come from texture_odometry; false: from the topics, with the last pose "
                       "as the prior")),
      choice(
          "on_clock_jump", &on_clock_jump, {"reset", "keep"},
          "what a clock that goes back does to the map: begin anew, or keep it and find the sensor in it")};
}

}  // namespace depth_fusion
