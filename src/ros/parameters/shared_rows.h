// Rows of parameters that several nodelets have.
#pragma once

#include <string>

#include "depth_fusion/common/parameters.h"

namespace depth_fusion {

Parameter deviceRow(std::string& device);
Parameter queueSizeRow(int& frames);

}  // namespace depth_fusion
