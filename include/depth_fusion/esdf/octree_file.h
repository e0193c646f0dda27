// Space as an octree of OctoMap.
#pragma once

#include <string>

#include "depth_fusion/esdf/esdf_grid.h"

namespace depth_fusion {

struct OctreeSize {
  size_t occupied = 0, free = 0;  // cells, before equal ones are joined
  size_t bytes = 0;
};

// Whether this was built with OctoMap.
bool hasOctrees();
// Writes the free and the occupied cells: a path that ends with .bt gets them alone, one with .ot
// probabilities. Throws Error for another ending, if nothing is known, if the file cannot be written, and
// without OctoMap.
OctreeSize writeOctree(const std::string& path, const EsdfGrid& space);

}  // namespace depth_fusion
