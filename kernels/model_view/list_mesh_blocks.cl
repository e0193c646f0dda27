// The blocks that marching cubes polygonises for a view, and batches of them: cores, which emit triangles,
// then the blocks beyond their far sides, which lend them vertices. A work-item is one slot of the groups in
// view (list_surface_blocks), one core or one member.
//   members  slots of a batch, the cores first
//   places   of each slot in the batch, or PLACE_NONE
//   blocks   what kernels/surface_mesh needs to know of the members
#include "shared/block_map.h"
#include "shared/image.h"

#define PLACE_NONE (-1)
#define PLACE_CLAIMED (-2)

// Lists the blocks near the surface whose cells, which reach a voxel beyond the block, may be in the view.
__kernel void list_surface_blocks(__global const int* groups, int group_count, int slots,
                                  __global const int4* block_indices, __global const int* block_states,
                                  __global int* listed, __global int* count, CameraArgs camera,
                                  TransformArgs T_D_W, GridArgs grid, float min_range_m, float max_range_m) {
  const int slot = slot_in_view(groups, group_count, slots);
  if (slot < 0) return;
  const int4 index = block_indices[slot];
  if (index.w == 0 || !(block_states[slot] & BLOCK_NEAR_SURFACE)) return;
  const float cells_m = grid.voxel_size_m * (BLOCK_SIZE + 1);
  const float3 centre_W = convert_float3(index.xyz) * (grid.voxel_size_m * BLOCK_SIZE) + 0.5f * cells_m;
  const float3 centre = transform_point(T_D_W, centre_W);
  const float radius = 0.8660254f * cells_m;
  if (centre.z + radius < min_range_m || centre.z - radius > max_range_m) return;
  if (sphere_in_view(centre, radius, camera)) listed[atomic_inc(count)] = slot;
}

inline int slot_beyond(int n, int3 block, __global const int* offsets, const GridArgs grid) {
  const int address = block_address(block + ((int3)(n, n >> 1, n >> 2) & 1), grid);
  return address < 0 ? BLOCK_EMPTY : offsets[address];
}

__kernel void place_cores(__global const int* members, __global int* places, int cores) {
  const int i = get_global_id(0);
  if (i < cores) places[members[i]] = i;
}

// `count` is the number of members; it begins as that of the cores. Each lender is claimed once.
__kernel void place_lenders(__global int* members, __global int* places, __global int* count,
                            __global const int4* block_indices, __global const int* offsets, int cores,
                            GridArgs grid) {
  const int i = get_global_id(0);
  if (i >= cores) return;
  const int3 block = block_indices[members[i]].xyz;
  for (int n = 1; n < 8; ++n) {
    const int slot = slot_beyond(n, block, offsets, grid);
    if (slot < 0 || places[slot] != PLACE_NONE) continue;
    if (atomic_cmpxchg(places + slot, PLACE_NONE, PLACE_CLAIMED) != PLACE_NONE) continue;
    const int place = atomic_inc(count);
    members[place] = slot;
    atomic_xchg(places + slot, place);
  }
}

__kernel void describe_members(__global MeshBlockArgs* blocks, __global const int* members,
                               __global const int* places, __global const int4* block_indices,
                               __global const int* offsets, int cores, int count, GridArgs grid) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const int3 block = block_indices[members[i]].xyz;
  vstore3(block, 0, blocks[i].index);
  for (int n = 0; n < 8; ++n) {
    const int slot = i < cores ? slot_beyond(n, block, offsets, grid) : BLOCK_EMPTY;
    blocks[i].neighbours[n] = slot < 0 ? -1 : places[slot];
  }
}

// `firsts` holds, for each member, the numbers of its first vertex and of its first triangle.
__kernel void number_members(__global MeshBlockArgs* blocks, __global const uint2* firsts, int count) {
  const int i = get_global_id(0);
  if (i >= count) return;
  blocks[i].first_vertex = firsts[i].x;
  blocks[i].first_triangle = firsts[i].y;
}

__kernel void clear_places(__global const int* members, __global int* places, int count) {
  const int i = get_global_id(0);
  if (i < count) places[members[i]] = PLACE_NONE;
}
