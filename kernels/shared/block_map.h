// Addresses in the block-sparse map. BLOCK_SIZE_LOG2: log2 of the voxels per block axis.
#include "shared/simd.h"
#include "shared/types.h"
#ifndef BLOCK_SIZE_LOG2
#define BLOCK_SIZE_LOG2 3
#endif
#define BLOCK_SIZE (1 << BLOCK_SIZE_LOG2)
#define BLOCK_VOXELS (1 << (3 * BLOCK_SIZE_LOG2))

// Returns the index in the offset buffer of the block with the given coordinates, or -1 outside of the
// window.
inline int block_address(int3 block, const GridArgs grid) {
  const int n = grid.blocks_per_axis;
  int3 in_window = block - (int3)(grid.origin[0], grid.origin[1], grid.origin[2]);
  if (any(in_window < 0) || any(in_window >= n)) return -1;
  in_window += (int3)(grid.wrapped_origin[0], grid.wrapped_origin[1], grid.wrapped_origin[2]);
  in_window = select(in_window, in_window - n, in_window >= n);
  return in_window.x + n * (in_window.y + n * in_window.z);
}

// Returns the slot with the given number among those of the groups in view, or -1 if there is none.
inline int numbered_slot(int number, __global const int* groups, int group_count, int slots) {
  if (number >= group_count * SLOTS_PER_GROUP) return -1;
  const int slot = groups[number / SLOTS_PER_GROUP] * SLOTS_PER_GROUP + number % SLOTS_PER_GROUP;
  return slot < slots ? slot : -1;
}

// Returns the work-item's slot of the groups in view, or -1 if it has none.
inline int slot_in_view(__global const int* groups, int group_count, int slots) {
  return numbered_slot(get_global_id(0), groups, group_count, slots);
}

// Returns the number of a voxel in its block.
inline int voxel_number(int3 in_block) {
  return in_block.x + (in_block.y << BLOCK_SIZE_LOG2) + (in_block.z << (2 * BLOCK_SIZE_LOG2));
}

// Returns the number of a block's first colour in the colour pool.
inline size_t block_colors(int slot) { return (size_t)slot * BLOCK_VOXELS; }

// Return the byte offsets of a block's distances and certainties in the voxel pool.
inline size_t block_distances(int slot) { return (size_t)slot * (2 * BLOCK_VOXELS); }
inline size_t block_certainties(int slot) { return (size_t)slot * (2 * BLOCK_VOXELS) + BLOCK_VOXELS; }
