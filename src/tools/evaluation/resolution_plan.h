// Which number of blocks N and voxels per block M to take (the paper's section "Resolution and Memory
// Consumption").
#pragma once

#include <cstddef>
#include <vector>

#include "depth_fusion/map/block_map.h"

namespace depth_fusion {

struct PlanRequest {
  double box_m = 4.0;  // edge of the window
  double wished_voxel_m = 0.005;
  size_t limit_bytes = size_t{1536} << 20;
  MapParameters map;  // what is not chosen: truncation, colour
};

struct PlanRow {
  MapParameters map;
  bool counted = false;  // else the offsets alone are over the limit, and `bytes` is theirs
  bool tried = false;    // the blocks are those that fusion had in use at the end
  size_t blocks = 0;
  size_t bytes = 0;
};

struct ResolutionPlan {
  PlanRequest request;
  std::vector<PlanRow> rows;  // by voxels per axis, then by block size
};

// Lists the sensible choices, whose blocks are not counted yet: N * M from 512 to 5000, and those of the
// wished voxel size. Throws Error for a box, voxel size or limit that no map can have.
ResolutionPlan resolutionChoices(const PlanRequest& request);

// Notes the number of blocks that the surface meets.
void setBlocks(PlanRow& row, size_t blocks);

bool fits(const PlanRow& row, const PlanRequest& request);

// The row with the largest voxels that are not larger than wished, or else with the smallest, of those that
// fit; where several are of that size, the one that is fastest to map with. Null if none fits.
PlanRow* recommended(ResolutionPlan& plan);

// Returns the MiB of a pool for the row's blocks, with a quarter to spare; see map/pool_mib.
int poolMebibytes(const PlanRow& row);

}  // namespace depth_fusion
