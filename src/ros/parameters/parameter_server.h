// The stages' parameter tables, filled from the parameter server.
#pragma once

#include <ros/node_handle.h>

#include <string>

#include "depth_fusion/common/parameters.h"

namespace depth_fusion {

// Sets the rows from the parameters of the node handle's namespace. Throws Error for a parameter that is no
// row (naming the nearest one), of another type, or out of range; those below `foreign`, unless it is empty,
// are somebody else's.
void loadParameters(const ros::NodeHandle& handle, const ParameterTable& table,
                    const std::string& foreign = "");

}  // namespace depth_fusion
