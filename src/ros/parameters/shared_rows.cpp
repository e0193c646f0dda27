#include "ros/parameters/shared_rows.h"

namespace depth_fusion {

Parameter deviceRow(std::string& device) {
  return atStartOnly(
      text("device", &device, "OpenCL device: index, part of its name, cpu or gpu; empty: the best"));
}

Parameter queueSizeRow(int& frames) {
  return atStartOnly(
      number("queue_size", &frames, 1, 1000, "frames that wait at most; the oldest are dropped"));
}

}  // namespace depth_fusion
