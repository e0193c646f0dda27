#include "ros/output/map_keeper_parameters.h"

namespace depth_fusion {

ParameterTable MapKeeperParameters::table() {
  return atStartOnly(
      {text(
           "map_file", &map_file,
           "where the map is kept: a file, relative below ROS_HOME, or postgresql://USER@HOST/DATABASE#NAME; "
           "it is loaded from there at the start, if it is there, and saved in the end; empty: nowhere"),
       number("save_period_s", &save_period_s, 0.0, 86400.0,
              "time from one save to map_file to the next; 0: in the end only"),
       flag("read_only", &read_only,
            "true: poses against the map of map_file, which stays as it is, and is never saved there")});
}

}  // namespace depth_fusion
