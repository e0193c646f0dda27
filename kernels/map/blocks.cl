// Bookkeeping of blocks. A work-item is one block (assign_blocks, withdraw_requests, remove_blocks) or as
// many bytes of it as 16 voxels have (gather_slots, scatter_slots, clear_blocks).
//   offsets        slot or BLOCK_EMPTY a block of the window
//   block_indices  index and in-use flag a slot
//   requests       index a block
//   slots          slot a request, or a block
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

// Copy blocks of a layer between their slots and a list of blocks, one after the other; as many bytes a
// work-item as clear_blocks.
__kernel void gather_slots(__global const uchar* layer, __global uchar* blocks, int bytes_per_voxel,
                           __global const int* slots, int count) {
  const int items_per_block = BLOCK_VOXELS / 16;
  const int i = get_global_id(0) / items_per_block;
  if (i >= count) return;
  __global const uchar* source = layer + (size_t)slots[i] * BLOCK_VOXELS * bytes_per_voxel;
  __global uchar* target = blocks + (size_t)i * BLOCK_VOXELS * bytes_per_voxel;
  for (int k = get_global_id(0) % items_per_block; k < items_per_block * bytes_per_voxel;
       k += items_per_block)
    vstore16(vload16(k, source), k, target);
}

__kernel void scatter_slots(__global uchar* layer, __global const uchar* blocks, int bytes_per_voxel,
                            __global const int* slots, int count) {
  const int items_per_block = BLOCK_VOXELS / 16;
  const int i = get_global_id(0) / items_per_block;
  if (i >= count) return;
  __global const uchar* source = blocks + (size_t)i * BLOCK_VOXELS * bytes_per_voxel;
  __global uchar* target = layer + (size_t)slots[i] * BLOCK_VOXELS * bytes_per_voxel;
  for (int k = get_global_id(0) % items_per_block; k < items_per_block * bytes_per_voxel;
       k += items_per_block)
    vstore16(vload16(k, source), k, target);
}

// Copies a cleared block of a layer to the slots, 16 bytes of each of its bytes_per_voxel M^3 bytes.
__kernel void clear_blocks(__global uchar* layer, __global const uchar* cleared_block, int bytes_per_voxel,
                           __global const int* slots, int count) {
  const int items_per_block = BLOCK_VOXELS / 16;
  const int i = get_global_id(0) / items_per_block;
  const int part = get_global_id(0) % items_per_block;
  if (i >= count) return;
  __global uchar* block = layer + (size_t)slots[i] * BLOCK_VOXELS * bytes_per_voxel;
  for (int k = part; k < items_per_block * bytes_per_voxel; k += items_per_block)
    vstore16(vload16(k, cleared_block), k, block);
}

__kernel void withdraw_requests(__global int* offsets, __global const int4* requests, int count,
                                GridArgs grid) {
  const int i = get_global_id(0);
  if (i < count) offsets[block_address(requests[i].xyz, grid)] = BLOCK_EMPTY;
}

__kernel void remove_blocks(__global int* offsets, __global int4* block_indices, __global const int* slots,
                            int count, GridArgs grid) {
  const int i = get_global_id(0);
  if (i >= count) return;
  offsets[block_address(block_indices[slots[i]].xyz, grid)] = BLOCK_EMPTY;
  block_indices[slots[i]].w = 0;
}
