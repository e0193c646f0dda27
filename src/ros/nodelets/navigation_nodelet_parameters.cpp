#include "ros/nodelets/navigation_nodelet_parameters.h"

namespace depth_fusion {

ParameterTable NavigationNodeletParameters::table() {
  const ParameterTable own = {
      atStartOnly(text("map", &map, "the nodelet that has the map; empty: tsdf_fusion beside this one")),
      number("publish_rate_hz", &publish_rate_hz, 0.1, 30.0, "of updates of all topics, at most"),
      number("keep_s", &keep_s, 0.0, 86400.0,
             "how long what is known of space is kept while nobody asks for it")};
  return joined({navigation.table(), own});
}

}  // namespace depth_fusion
