// Blocks' contents between the device and the host.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "depth_fusion/compute/device_buffer.h"

namespace depth_fusion {

// The elements of so many bytes in these slots of a buffer, one after the other; slots in a row travel
// together.
std::string readSlots(const DeviceBuffer& buffer, const std::vector<int>& slots, size_t bytes_per_slot);
void writeSlots(DeviceBuffer& buffer, const std::vector<int>& slots, const std::string& contents,
                size_t bytes_per_slot);

}  // namespace depth_fusion
