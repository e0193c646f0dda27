// Block selection: which blocks does the measured surface meet, and which allocated blocks does the camera see.
//   requests  indices of the blocks claimed, in any order
//   points_outside  counts the samples of the surface that lie outside of the window
//   visible   slots of the blocks to update, in any order
//   count     entries of the list, 0 before; may end above the list's capacity
#include "shared/image.h"
#include "shared/window.h"

typedef struct {
  vint x, y, z;    // block indices
  vint address;    // in the offsets; any where it is not `inside`
  vint inside;     // of the window
} Blocks;

inline Blocks blocks_with(vfloat x, vfloat y, vfloat z, const GridArgs grid) {
  const float per_block = 1.0f / (grid.voxel_size_m * BLOCK_SIZE);
  const int n = grid.blocks_per_axis;
  Blocks blocks;
  blocks.x = TO_VINT(floor(x * per_block));
  blocks.y = TO_VINT(floor(y * per_block));
  blocks.z = TO_VINT(floor(z * per_block));
  const vint in_x = blocks.x - grid.origin[0], in_y = blocks.y - grid.origin[1], in_z = blocks.z - grid.origin[2];
  blocks.inside = in_window(in_x, n) & in_window(in_y, n) & in_window(in_z, n);
  blocks.address = window_address(in_x, in_y, in_z, grid);
  return blocks;
}

// Each block with one atomic, so that it is asked for once. A claim that finds the list full is withdrawn.
inline void claim(const Blocks blocks, vint wanted, __global int *offsets, __global int4 *requests,
                  __global int *count, int capacity) {
  int claims[SIMD_WIDTH], x[SIMD_WIDTH], y[SIMD_WIDTH], z[SIMD_WIDTH], address[SIMD_WIDTH];
  VSTORE(wanted, claims);
  VSTORE(blocks.x, x);
  VSTORE(blocks.y, y);
  VSTORE(blocks.z, z);
  VSTORE(blocks.address, address);
  for (int i = 0; i < SIMD_WIDTH; ++i) {
    if (!claims[i]) continue;
    if (atomic_cmpxchg(offsets + address[i], BLOCK_EMPTY, BLOCK_REQUESTED) != BLOCK_EMPTY) continue;
    const int entry = atomic_inc(count);
    if (entry < capacity) {
      requests[entry] = (int4)(x[i], y[i], z[i], 0);
    } else {
      atomic_xchg(offsets + address[i], BLOCK_EMPTY);
    }
  }
}

// A work-item samples SIMD_WIDTH pixels of a row, walks the truncation band along their rays, and claims the empty blocks
// it meets.
__kernel void request_blocks(__global const float *depth, __global int *offsets, __global int4 *requests,
                             __global int *count, __global int *points_outside, CameraArgs camera,
                             TransformArgs T_W_D, GridArgs grid, SelectionArgs args) {
  const int first_column = get_global_id(0) * SIMD_WIDTH;
  const vint column = first_column + LANE_INDICES;
  const vint x = column * args.stride_px + args.stride_px / 2;
  const int row = get_global_id(1), y = row * args.stride_px + args.stride_px / 2;
  if (y >= camera.height) return;
  const vint in_image = x < camera.width;
  const vfloat z = GATHER(vfloat, depth, pixel_indices(select((vint)(0), x, in_image), y, camera));
  const vint sampled = in_image & (z > 0.0f) & ((z >= args.dense_from_m) | (((column | row) & 1) == 0));
  if (!ANY(sampled)) return;

  const vfloat ray_x = (TO_VFLOAT(x) - camera.cx) / camera.fx;
  const float ray_y = (y - camera.cy) / camera.fy;
  const vfloat ray_Wx = rotated(T_W_D, 0, ray_x, ray_y, 1.0f), ray_Wy = rotated(T_W_D, 1, ray_x, ray_y, 1.0f),
               ray_Wz = rotated(T_W_D, 2, ray_x, ray_y, 1.0f);
  const vfloat half_band = grid.truncation_m * rsqrt(ray_x * ray_x + (ray_y * ray_y + 1.0f));
  for (int i = 0; i < args.band_samples; ++i) {
    const vfloat t = z + half_band * (2.0f * i / (args.band_samples - 1) - 1.0f);
    const Blocks blocks = blocks_with(T_W_D.translation[0] + t * ray_Wx, T_W_D.translation[1] + t * ray_Wy,
                                      T_W_D.translation[2] + t * ray_Wz, grid);
    const vint met = sampled & blocks.inside;
    const vint wanted = met & (GATHER(vint, offsets, select((vint)(0), blocks.address, met)) == BLOCK_EMPTY);
    if (ANY(wanted)) claim(blocks, wanted, offsets, requests, count, args.capacity);
  }
  const Blocks surface = blocks_with(T_W_D.translation[0] + z * ray_Wx, T_W_D.translation[1] + z * ray_Wy,
                                     T_W_D.translation[2] + z * ray_Wz, grid);
  const vint outside = sampled & NOT(surface.inside);
  if (ANY(outside)) atomic_add(points_outside, (int)SUM_LANES(select((vfloat)(0.0f), (vfloat)(1.0f), outside)));
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
