// Stored maps looked through, and what can be read of damaged ones saved.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "depth_fusion/store/database.h"
#include "depth_fusion/submaps/map_description.h"

namespace depth_fusion {

struct MapCheck {
  MapDescription description;
  std::map<std::string, uint64_t> blocks;     // of each layer
  std::map<std::string, uint64_t> row_bytes;  // that each layer's rows take, and "keyframes"
  uint64_t keyframes = 0;
  std::vector<std::string> problems;  // of rows that are damaged, missing or of no use
};

// Reads every row. Throws Error if the map cannot even say what it is.
MapCheck checkMap(Database& database);

// What a rescue saved, and what it gave up.
struct MapRescue {
  uint64_t blocks = 0, blocks_lost = 0;
  uint64_t keyframes = 0;
  std::vector<std::string> problems;
};

// Writes what can be read of a damaged map to another place, where nothing is yet. Throws Error if not even
// the map's description can be read.
MapRescue rescueMap(const std::string& damaged, const std::string& rescued);

}  // namespace depth_fusion
