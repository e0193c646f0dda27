// Places of cells, and of voxels in them.
#include "esdf/types.h"
#include "shared/block_map.h"

// Rounds down.
inline int floor_division(int a, int b) { return a >= 0 ? a / b : -((-a - 1) / b) - 1; }

// Returns the number of a cell in its block.
inline int cell_number(int3 cell) {
  const int3 in_block = cell & (ESDF_BLOCK - 1);
  return in_block.x + ESDF_BLOCK * (in_block.y + ESDF_BLOCK * in_block.z);
}
