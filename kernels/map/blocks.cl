// Bookkeeping of blocks. A work-item is one block (assign_blocks, withdraw_requests) or 16 voxels
// (clear_blocks, clear_colors).
//   offsets        slot or BLOCK_EMPTY a block of the window
//   block_indices  index and in-use flag a slot
//   requests       index a block
//   slots          slot a request
#include "shared/block_map.h"

__kernel void assign_blocks(__global int* offsets, __global int4* block_indices, __global int* block_states,
                            __global const int4* requests, __global const int* slots, int count,
                            GridArgs grid) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const int slot = slots[i];
  offsets[block_address(requests[i].xyz, grid)] = slot;
  block_indices[slot] = (int4)(requests[i].xyz, 1);
  block_states[slot] = 0;
}

__kernel void clear_blocks(__global char* voxels, __global const int* slots, int count) {
  const int items_per_block = BLOCK_VOXELS / 16;
  const int i = get_global_id(0) / items_per_block;
  const int part = get_global_id(0) % items_per_block;
  if (i >= count) return;
  vstore16((char16)(TSDF_CHI), part, voxels + block_distances(slots[i]));
  vstore16((char16)(0), part, voxels + block_certainties(slots[i]));
}

__kernel void clear_colors(__global uint* colors, __global const int* slots, int count) {
  const int items_per_block = BLOCK_VOXELS / 16;
  const int i = get_global_id(0) / items_per_block;
  const int part = get_global_id(0) % items_per_block;
  if (i < count) vstore16((uint16)(0), part, colors + block_colors(slots[i]));
}

__kernel void withdraw_requests(__global int* offsets, __global const int4* requests, int count,
                                GridArgs grid) {
  const int i = get_global_id(0);
  if (i < count) offsets[block_address(requests[i].xyz, grid)] = BLOCK_EMPTY;
}
