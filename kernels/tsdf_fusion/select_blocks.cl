// Block selection finds which blocks the measured surface meets, and which allocated blocks the camera sees.
//   requests  indices of the blocks claimed, in any order
//   points_outside  counts the samples of the surface that lie outside of the window
//   visible   slots of the blocks to update, in any order
//   count     entries of the list, 0 before; may end above the list's capacity
#include "shared/image.h"
#include "shared/window.h"

typedef struct {
  vint x, y, z;  // block indices
  vint address;  // in the offsets; any where it is not `inside`
  vint inside;   // of the window
} Blocks;

inline Blocks blocks_with(vfloat x, vfloat y, vfloat z, const GridArgs grid) {
  const float per_block = 1.0f / (grid.voxel_size_m * BLOCK_SIZE);
  const int n = grid.blocks_per_axis;
  Blocks blocks;
  blocks.x = TO_VINT(floor(x * per_block));
  blocks.y = TO_VINT(floor(y * per_block));
  blocks.z = TO_VINT(floor(z * per_block));
  const vint in_x = blocks.x - grid.origin[0], in_y = blocks.y - grid.origin[1],
             in_z = blocks.z - grid.origin[2];
  blocks.inside = in_window(in_x, n) & in_window(in_y, n) & in_window(in_z, n);
  blocks.address = window_address(in_x, in_y, in_z, grid);
  return blocks;
}

// Claims each block with one atomic, so that it is asked for once. A claim that finds the list full is
// withdrawn.
inline void claim(const Blocks blocks, vint wanted, __global int* offsets, __global int4* requests,
                  __global int* count, int capacity) {
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

// A work-item samples SIMD_WIDTH pixels of a row, walks the truncation band along their rays, and claims the
// empty blocks it meets.
__kernel void request_blocks(__global const float* depth, __global int* offsets, __global int4* requests,
                             __global int* count, __global int* points_outside, CameraArgs camera,
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
  if (ANY(outside))
    atomic_add(points_outside, (int)SUM_LANES(select((vfloat)(0.0f), (vfloat)(1.0f), outside)));
}

// A pixel's depth was filtered from pixels up to so far away.
#define FILTER_REACH_PX 2.5f

// Returns the first and the last column, or row, that may have to do with points between from_m and to_m
// beside the axis, at depths between nearest and farthest.
inline int2 pixel_range(float from_m, float to_m, float nearest, float farthest, float f, float c, int size) {
  const float first = f * from_m / (from_m < 0.0f ? nearest : farthest) + c - FILTER_REACH_PX;
  const float last = f * to_m / (to_m < 0.0f ? farthest : nearest) + c + FILTER_REACH_PX;
  return (int2)(clamp((int)first, 0, size - 1), clamp((int)last, 0, size - 1));
}

inline float half_extent(const TransformArgs T_D_W, int row, float block_m) {
  __private const float* r = T_D_W.rotation + 3 * row;
  return 0.5f * block_m * (fabs(r[0]) + fabs(r[1]) + fabs(r[2]));
}

// A block is visible if the box around it, along the camera's axes, meets the image where the measured depth,
// plus the truncation, is not in front of it.
inline bool is_visible(int3 block, __global const float* max_tiles, const CameraArgs camera,
                       const TransformArgs T_D_W, const GridArgs grid) {
  const float block_m = grid.voxel_size_m * BLOCK_SIZE;
  const float radius = 0.8660254f * block_m;
  const float3 centre = transform_point(T_D_W, (convert_float3(block) + 0.5f) * block_m);
  if (!sphere_in_view(centre, radius, camera)) return false;
  const float half_x = half_extent(T_D_W, 0, block_m), half_y = half_extent(T_D_W, 1, block_m);
  const float half_z = half_extent(T_D_W, 2, block_m);
  const float nearest = centre.z - half_z;
  int2 x = (int2)(0, camera.width - 1), y = (int2)(0, camera.height - 1);
  if (nearest > 0.1f) {
    x = pixel_range(centre.x - half_x, centre.x + half_x, nearest, centre.z + half_z, camera.fx, camera.cx,
                    camera.width);
    y = pixel_range(centre.y - half_y, centre.y + half_y, nearest, centre.z + half_z, camera.fy, camera.cy,
                    camera.height);
  }
  const int tile_columns = (camera.width + DEPTH_TILE - 1) / DEPTH_TILE;
  float farthest = 0.0f;
  for (int row = y.lo / DEPTH_TILE; row <= y.hi / DEPTH_TILE; ++row) {
    for (int column = x.lo / DEPTH_TILE; column <= x.hi / DEPTH_TILE; ++column) {
      farthest = fmax(farthest, max_tiles[row * tile_columns + column]);
    }
  }
  return farthest > 0.0f && nearest <= farthest + grid.truncation_m / MIN_COSINE;
}

// A work-item tests SLOTS_PER_ITEM slots of the groups in view.
__kernel void list_visible_blocks(__global const int* groups, int group_count, int slots,
                                  __global const int4* block_indices, __global int* block_states,
                                  __global const float* max_tiles, __global int* visible, __global int* count,
                                  CameraArgs camera, TransformArgs T_D_W, GridArgs grid) {
  int found[SLOTS_PER_ITEM(SIMD_WIDTH)], found_count = 0;
  for (int i = 0; i < SLOTS_PER_ITEM(SIMD_WIDTH); ++i) {
    const int number = get_global_id(0) * SLOTS_PER_ITEM(SIMD_WIDTH) + i;
    const int slot = numbered_slot(number, groups, group_count, slots);
    if (slot < 0 || block_indices[slot].w == 0) continue;
    if (is_visible(block_indices[slot].xyz, max_tiles, camera, T_D_W, grid)) found[found_count++] = slot;
  }
  if (found_count == 0) return;
  const int first = atomic_add(count, found_count);
  for (int i = 0; i < found_count; ++i) {
    block_states[found[i]] &= BLOCK_SURE;
    visible[first + i] = found[i];
  }
}

// A work-item tests one block of the visible list after fusion; those without data leave the map.
__kernel void list_empty_blocks(__global int* offsets, __global int4* block_indices,
                                __global const int* block_states, __global const int* visible,
                                int visible_count, __global int* empty, __global int* count, GridArgs grid) {
  const int i = get_global_id(0);
  if (i >= visible_count) return;
  const int slot = visible[i];
  if (block_states[slot] & BLOCK_HAS_DATA) return;
  offsets[block_address(block_indices[slot].xyz, grid)] = BLOCK_EMPTY;
  block_indices[slot].w = 0;
  empty[atomic_inc(count)] = slot;
}
