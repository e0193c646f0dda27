// A recording whose frames are registered.
#pragma once

#include <memory>

#include "depth_fusion/compute/compute_context.h"
#include "depth_fusion/recording/recording.h"
#include "depth_fusion/registration/registration_parameters.h"

namespace depth_fusion {

// Gives the recording with its frames registered.
std::unique_ptr<Recording> registered(std::unique_ptr<Recording> recording, ComputeContext& compute,
                                      const RegistrationParameters& parameters);

}  // namespace depth_fusion
