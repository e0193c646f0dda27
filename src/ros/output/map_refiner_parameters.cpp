#include "ros/output/map_refiner_parameters.h"

namespace depth_fusion {

ParameterTable MapRefinerParameters::table() {
  return {atStartOnly(flag("close_loops", &close_loops,
                           "true: places that are seen again are recognised, and the map is corrected; needs "
                           "poses from icp_tracking"))};
}

}  // namespace depth_fusion
