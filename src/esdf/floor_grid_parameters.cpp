#include "depth_fusion/esdf/floor_grid_parameters.h"

namespace depth_fusion {

ParameterTable FloorGridParameters::table() {
  return {
      number("min_height_m", &min_height_m, 0.0, 10.0, "what is lower above the ground is no obstacle"),
      number("max_height_m", &max_height_m, 0.01, 100.0, "nor is what is higher"),
      flag("find_ground", &find_ground,
           "true: the ground is the level that most of what can be stood on has; false: ground_z_m"),
      number("ground_z_m", &ground_z_m, -1000.0, 1000.0, "the ground's height in the map, where it is given"),
      number("max_step_m", &max_step_m, 0.0, 1.0,
             "the ground goes on up and down slopes and steps of this height from a cell to the next; 0: it "
             "is flat")};
}

}  // namespace depth_fusion
