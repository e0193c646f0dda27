// How depth and colour are taken from a driver's topics.
#pragma once

#include <string>

#include "depth_fusion/common/parameters.h"
#include "depth_fusion/registration/registration_parameters.h"

namespace depth_fusion {

struct PairingParameters {
  float max_gap_s = 0.02f;  // colour farther in time from its depth is left out
  float max_wait_s = 0.1f;  // how long a depth image waits for its colour
};

struct RgbdParameters {
  std::string depth_transport = "auto";  // raw, compressedDepth or compressed
  std::string color_transport = "auto";  // raw or compressed
  PairingParameters pairing;
  RegistrationParameters registration;  // has a table of its own

  // All rows but those of the registration.
  ParameterTable table();
};

}  // namespace depth_fusion
