// Real recordings, which lie beside the repository.
#pragma once

#include <cstdlib>
#include <string>

namespace depth_fusion {

// Returns DEPTH_FUSION_DATA, or else ../shared/data; tests run in the repository's root.
inline std::string realDataFolder(const std::string& name) {
  const char* folder = std::getenv("DEPTH_FUSION_DATA");
  return std::string(folder != nullptr ? folder : "../shared/data") + "/" + name;
}

}  // namespace depth_fusion
