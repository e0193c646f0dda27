#include "ros/output/navigation_parameters.h"

namespace depth_fusion {

ParameterTable NavigationParameters::table() {
  const ParameterTable own = {
      number("slice_z_m", &slice_z_m, -1000.0, 1000.0, "height in the map of esdf_slice"),
      text("scan_frame", &scan_frame,
           "a level frame of the robot on tf, from which scan and obstacles are seen; empty: there are none"),
      number("scan_range_m", &scan_range_m, 0.1, 100.0, "range of scan and obstacles")};
  return joined({grid.table(), own});
}

}  // namespace depth_fusion
