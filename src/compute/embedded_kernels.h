// The text of the files below kernels/, compiled into the library (see cmake/EmbedFiles.cmake).
#pragma once

#include <string>

namespace depth_fusion {

// path: below kernels/, as "map/blocks.cl". Throws Error if there is no such file.
std::string embeddedKernelSource(const std::string& path);

}  // namespace depth_fusion
