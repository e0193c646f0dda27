// The surface of a stored map.
#pragma once

#include "apps/view/model.h"

namespace depth_fusion {

// The way is that of the keyframes. Throws Error if there is no such map.
ViewedModel readStoredModel(const std::string& location, bool with_certainty, const std::string& device);

}  // namespace depth_fusion
