// Blocks of the window, by coordinates that count from its first block.
#include "shared/block_map.h"

// Wraps block coordinates of the window, already in it, to the coordinates of its offsets.
inline vint wrap(vint block, int wrapped_origin, int blocks_per_axis) {
  const vint wrapped = block + wrapped_origin;
  return select(wrapped, wrapped - blocks_per_axis, wrapped >= blocks_per_axis);
}

inline vint in_window(vint block, int blocks_per_axis) { return AS_VUINT(block) < (uint)blocks_per_axis; }
