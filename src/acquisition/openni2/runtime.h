// The runtime of OpenNI2 and the devices that its drivers have found.
#pragma once

#include <OpenNI.h>

#include <string>

namespace depth_fusion {

// Keeps OpenNI2 initialised as long as there is such an object.
class OpenNi2Runtime {
 public:
  // Throws Error if no driver can be loaded.
  OpenNi2Runtime();
  ~OpenNi2Runtime();
  OpenNi2Runtime(const OpenNi2Runtime&) = delete;
  OpenNi2Runtime& operator=(const OpenNi2Runtime&) = delete;
};

// Gives the runtime's own words on what failed last, in one line.
std::string openNi2Error();

bool isPlugged(const std::string& uri);

// Gives the URI of the device that openDevice()'s `device_id` means. Throws Error naming those that there
// are.
std::string findDevice(const std::string& device_id);

// Gives the device's serial number, or an empty text if it has none.
std::string serialOf(openni::Device& device);

}  // namespace depth_fusion
