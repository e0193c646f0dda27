// Block selection: which blocks does the measured surface meet, and which allocated blocks does the camera see.
//   requests  indices of the blocks claimed, in any order
//   points_outside  counts the samples of the surface that lie outside of the window
//   visible   slots of the blocks to update, in any order
//   count     entries of the list, 0 before; may end above the list's capacity
#include "shared/block_map.h"
#include "shared/image.h"

// A work-item samples one pixel, walks the truncation band along its ray, and claims the empty blocks it meets, each
// with one atomic, so that a block is asked for once. A claim that finds the list full is withdrawn.
__kernel void request_blocks(__global const float *depth, __global int *offsets, __global int4 *requests,
                             __global int *count, __global int *points_outside, CameraArgs camera,
                             TransformArgs T_W_D, GridArgs grid, SelectionArgs args) {
  const int x = get_global_id(0) * args.stride_px + args.stride_px / 2;
  const int y = get_global_id(1) * args.stride_px + args.stride_px / 2;
  if (x >= camera.width || y >= camera.height) return;
  const float z = depth[pixel_index(x, y, camera)];
  if (!(z > 0.0f)) return;
  if (z < args.dense_from_m && ((get_global_id(0) | get_global_id(1)) & 1)) return;
  const float3 ray_D = (float3)((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1.0f);
  const float3 ray_W = rotate_point(T_W_D, ray_D);
  const float3 origin_W = (float3)(T_W_D.translation[0], T_W_D.translation[1], T_W_D.translation[2]);
  const float half_band = grid.truncation_m / length(ray_D);
  const float per_block = 1.0f / (grid.voxel_size_m * BLOCK_SIZE);
  if (block_address(convert_int3(floor((origin_W + z * ray_W) * per_block)), grid) < 0) atomic_inc(points_outside);
  int3 last_block = INT_MAX;
  for (int i = 0; i < args.band_samples; ++i) {
    const float t = z - half_band + 2.0f * half_band * i / (args.band_samples - 1);
    const int3 block = convert_int3(floor((origin_W + t * ray_W) * per_block));
    if (all(block == last_block)) continue;
    last_block = block;
    const int address = block_address(block, grid);
    if (address < 0 || offsets[address] != BLOCK_EMPTY) continue;
    if (atomic_cmpxchg(offsets + address, BLOCK_EMPTY, BLOCK_REQUESTED) != BLOCK_EMPTY) continue;
    const int entry = atomic_inc(count);
    if (entry < args.capacity) {
      requests[entry] = (int4)(block, 0);
    } else {
      atomic_xchg(offsets + address, BLOCK_EMPTY);
    }
  }
}

// A work-item tests one slot of the groups in view. A block is visible if the sphere around it meets the image where the measured depth,
// plus the truncation, is not in front of it.
__kernel void list_visible_blocks(__global const int *groups, int group_count, int slots,
                                  __global const int4 *block_indices, __global int *block_states,
                                  __global const float *max_tiles, __global int *visible, __global int *count,
                                  CameraArgs camera, TransformArgs T_D_W, GridArgs grid) {
  const int slot = slot_in_view(groups, group_count, slots);
  if (slot < 0) return;
  const int4 index = block_indices[slot];
  if (index.w == 0) return;
  const float block_m = grid.voxel_size_m * BLOCK_SIZE;
  const float radius = 0.8660254f * block_m;
  const float3 centre = transform_point(T_D_W, (convert_float3(index.xyz) + 0.5f) * block_m);
  if (!sphere_in_view(centre, radius, camera)) return;
  const float nearest = centre.z - radius;
  int x0 = 0, y0 = 0, x1 = camera.width - 1, y1 = camera.height - 1;
  if (nearest > 0.1f) {
    const float inverse = 1.0f / centre.z;
    const float u = camera.fx * centre.x * inverse + camera.cx;
    const float v = camera.fy * centre.y * inverse + camera.cy;
    const float extent_u = camera.fx * radius * inverse * 1.5f + 1.0f;
    const float extent_v = camera.fy * radius * inverse * 1.5f + 1.0f;
    x0 = clamp((int)(u - extent_u), 0, x1);
    y0 = clamp((int)(v - extent_v), 0, y1);
    x1 = clamp((int)(u + extent_u), 0, x1);
    y1 = clamp((int)(v + extent_v), 0, y1);
  }
  const int tile_columns = (camera.width + DEPTH_TILE - 1) / DEPTH_TILE;
  float farthest = 0.0f;
  for (int y = y0 / DEPTH_TILE; y <= y1 / DEPTH_TILE; ++y) {
    for (int x = x0 / DEPTH_TILE; x <= x1 / DEPTH_TILE; ++x) farthest = fmax(farthest, max_tiles[y * tile_columns + x]);
  }
  if (farthest <= 0.0f || nearest > farthest + grid.truncation_m / MIN_COSINE) return;
  block_states[slot] = 0;
  visible[atomic_inc(count)] = slot;
}

// A work-item tests one block of the visible list after fusion; those without data leave the map.
__kernel void list_empty_blocks(__global int *offsets, __global int4 *block_indices,
                                __global const int *block_states, __global const int *visible, int visible_count,
                                __global int *empty, __global int *count, GridArgs grid) {
  const int i = get_global_id(0);
  if (i >= visible_count) return;
  const int slot = visible[i];
  if (block_states[slot] & BLOCK_HAS_DATA) return;
  offsets[block_address(block_indices[slot].xyz, grid)] = BLOCK_EMPTY;
  block_indices[slot].w = 0;
  empty[atomic_inc(count)] = slot;
}
