// The files of page/, as they are built in.
#pragma once

#include <string>

namespace depth_fusion {

// Throws Error if there is none of that name.
std::string embeddedPagePart(const std::string& file);

}  // namespace depth_fusion
