// Finds blocks of the window by coordinates that count from its first block.
#include "shared/block_map.h"

// Wraps coordinates of blocks that lie in the window to coordinates in its offsets.
inline vint wrap(vint block, int wrapped_origin, int blocks_per_axis) {
  const vint wrapped = block + wrapped_origin;
  return select(wrapped, wrapped - blocks_per_axis, wrapped >= blocks_per_axis);
}

inline vint in_window(vint block, int blocks_per_axis) { return AS_VUINT(block) < (uint)blocks_per_axis; }

// The addresses, in the offsets, of blocks in the window. What comes for other blocks has no meaning.
inline vint window_address(vint x, vint y, vint z, const GridArgs grid) {
  const int n = grid.blocks_per_axis;
  return wrap(x, grid.wrapped_origin[0], n) +
         n * (wrap(y, grid.wrapped_origin[1], n) + n * wrap(z, grid.wrapped_origin[2], n));
}

// Returns the slots of the blocks at the addresses; -1 where there is no block, or where it is not `inside`.
inline vint slot_at(vint address, vint inside, __global const int* offsets) {
  return select((vint)(-1), GATHER(vint, offsets, select((vint)(0), address, inside)), inside);
}

// The places in the pool where the blocks' distances begin; that of slot 0 where there is no block.
inline vint distances_of(vint slot) { return max(slot, (vint)(0)) * (2 * BLOCK_VOXELS); }
