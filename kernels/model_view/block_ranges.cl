// Where the rays of each tile of the view can hit, by the octants of blocks that are near the surface. A work-item projects
// those of a slot of the groups in view.
#include "model_view/ray_ranges.h"
#include "shared/block_map.h"
#include "shared/image.h"

typedef struct {
  float3 lowest, highest;  // corners of a box along the axes of frame D
} Box;

inline void splat_box(const Box box, __global int *nearest, __global uint *occupied, const CameraArgs camera,
                      const RayRangeArgs range) {
  const float start = fmax(box.lowest.z, range.min_m), end = fmin(box.highest.z, range.max_m);
  if (start > end) return;
  // a box that reaches behind the camera covers what its part ahead of it covers
  const float near = 1.0f / fmax(box.lowest.z, 1e-3f), far = 1.0f / box.highest.z;
  const float u0 = camera.fx * fmin(box.lowest.x * near, box.lowest.x * far) + camera.cx;
  const float u1 = camera.fx * fmax(box.highest.x * near, box.highest.x * far) + camera.cx;
  const float v0 = camera.fy * fmin(box.lowest.y * near, box.lowest.y * far) + camera.cy;
  const float v1 = camera.fy * fmax(box.highest.y * near, box.highest.y * far) + camera.cy;
  if (u1 < 0.0f || v1 < 0.0f || u0 > camera.width - 1 || v0 > camera.height - 1) return;
  const int x0 = (int)fmax(u0, 0.0f) / RANGE_TILE, x1 = (int)fmin(u1 + 1.0f, camera.width - 1.0f) / RANGE_TILE;
  const int y0 = (int)fmax(v0, 0.0f) / RANGE_TILE, y1 = (int)fmin(v1 + 1.0f, camera.height - 1.0f) / RANGE_TILE;

  const int first_bin = depth_bin(start, range);
  const ulong bins = ((2ul << (depth_bin(end, range) - first_bin)) - 1) << first_bin;
  const uint low = (uint)bins, high = (uint)(bins >> 32);
  for (int y = y0; y <= y1; ++y) {
    for (int tile = y * tiles_across(camera.width) + x0; tile <= y * tiles_across(camera.width) + x1; ++tile) {
      if (nearest[tile] > as_int(start)) atomic_min(nearest + tile, as_int(start));
      if (low & ~occupied[2 * tile]) atomic_or(occupied + 2 * tile, low);
      if (high & ~occupied[2 * tile + 1]) atomic_or(occupied + 2 * tile + 1, high);
    }
  }
}

__kernel void splat_block_ranges(__global const int *groups, int group_count, int slots,
                                 __global const int4 *block_indices, __global const int *block_states,
                                 __global int *nearest, __global uint *occupied, CameraArgs camera,
                                 TransformArgs T_D_W, GridArgs grid, RayRangeArgs range) {
  const int slot = slot_in_view(groups, group_count, slots);
  if (slot < 0) return;
  const int4 index = block_indices[slot];
  const int octants = block_states[slot] & BLOCK_NEAR_SURFACE;
  if (index.w == 0 || octants == 0) return;
  const float quarter_m = 0.25f * grid.voxel_size_m * BLOCK_SIZE;
  const float3 middle = transform_point(T_D_W, (convert_float3(index.xyz) + 0.5f) * (4.0f * quarter_m));
  const float3 axis_x = quarter_m * (float3)(T_D_W.rotation[0], T_D_W.rotation[3], T_D_W.rotation[6]);
  const float3 axis_y = quarter_m * (float3)(T_D_W.rotation[1], T_D_W.rotation[4], T_D_W.rotation[7]);
  const float3 axis_z = quarter_m * (float3)(T_D_W.rotation[2], T_D_W.rotation[5], T_D_W.rotation[8]);
  const float3 reach = fabs(axis_x) + fabs(axis_y) + fabs(axis_z);
  if (!sphere_in_view(middle, 2.0f * 1.7320508f * quarter_m, camera)) return;
  if (middle.z + 2.0f * reach.z < range.min_m || middle.z - 2.0f * reach.z > range.max_m) return;
  for (int octant = 0; octant < 8; ++octant) {
    if (!(octants >> (octant + BLOCK_NEAR_SURFACE_SHIFT) & 1)) continue;
    const float3 centre = middle + (octant & 1 ? axis_x : -axis_x) + (octant & 2 ? axis_y : -axis_y) +
                          (octant & 4 ? axis_z : -axis_z);
    const Box box = {centre - reach, centre + reach};
    splat_box(box, nearest, occupied, camera, range);
  }
}
