// How depth and colour are taken from a driver's topics.
#pragma once

#include <string>
#include <vector>

#include "depth_fusion/common/parameters.h"
#include "depth_fusion/masking/masking_parameters.h"
#include "depth_fusion/registration/registration_parameters.h"

namespace depth_fusion {

struct PairingParameters {
  float max_gap_s = 0.02f;  // colour farther in time from its depth is left out
  float max_wait_s = 0.1f;  // how long a depth image waits for its colour
};

// The transports that are decoded here; raw is the first.
std::vector<std::string> ownDepthTransports();
std::vector<std::string> ownColorTransports();

struct RgbdParameters {
  std::string image_transport = "auto";
  std::string depth_transport = "auto";
  std::string color_transport = "auto";
  PairingParameters pairing;
  RegistrationParameters registration;  // has a table of its own, as has the next
  MaskingParameters masking;

  // All rows but those of registration and masking.
  ParameterTable table();
  std::string depthTransport() const;
  std::string colorTransport() const;
  // Throws Error if nothing here decodes one of the transports, and for a body of masking that is none.
  void checkTexts() const;
};

}  // namespace depth_fusion
