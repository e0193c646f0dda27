// The paper's start and end textures: for each 8x8 tile of the view, the range of depths in which a ray can hit. Only
// blocks near the surface count. A work-item projects one block.
//   nearest, farthest  depth in metres a tile; float bits as ints, whose order is the same for positive floats
#include "shared/block_map.h"
#include "shared/image.h"

__kernel void splat_block_ranges(__global const int4 *block_indices, __global const int *block_states, int slots,
                                 __global int *nearest, __global int *farthest, CameraArgs camera,
                                 TransformArgs T_D_W, GridArgs grid, float min_range_m, float max_range_m) {
  const int slot = get_global_id(0);
  if (slot >= slots) return;
  const int4 index = block_indices[slot];
  if (index.w == 0 || !(block_states[slot] & BLOCK_NEAR_SURFACE)) return;
  const float size = grid.voxel_size_m;
  const float block_m = size * BLOCK_SIZE;
  const float3 corner = transform_point(T_D_W, convert_float3(index.xyz) * block_m);
  const float3 axis_x = block_m * (float3)(T_D_W.rotation[0], T_D_W.rotation[3], T_D_W.rotation[6]);
  const float3 axis_y = block_m * (float3)(T_D_W.rotation[1], T_D_W.rotation[4], T_D_W.rotation[7]);
  const float3 axis_z = block_m * (float3)(T_D_W.rotation[2], T_D_W.rotation[5], T_D_W.rotation[8]);
  const float z0 = corner.z + fmin(axis_x.z, 0.0f) + fmin(axis_y.z, 0.0f) + fmin(axis_z.z, 0.0f);
  const float z1 = corner.z + fmax(axis_x.z, 0.0f) + fmax(axis_y.z, 0.0f) + fmax(axis_z.z, 0.0f);
  if (z1 < min_range_m || z0 > max_range_m) return;

  float u0 = 0.0f, v0 = 0.0f, u1 = camera.width - 1, v1 = camera.height - 1;
  if (z0 > 0.05f) {
    u0 = v0 = MAXFLOAT;
    u1 = v1 = -MAXFLOAT;
    for (int i = 0; i < 8; ++i) {
      const float3 p = corner + (i & 1 ? axis_x : 0.0f) + (i & 2 ? axis_y : 0.0f) + (i & 4 ? axis_z : 0.0f);
      const float u = camera.fx * p.x / p.z + camera.cx;
      const float v = camera.fy * p.y / p.z + camera.cy;
      u0 = fmin(u0, u);
      u1 = fmax(u1, u);
      v0 = fmin(v0, v);
      v1 = fmax(v1, v);
    }
    if (u1 < 0.0f || v1 < 0.0f || u0 > camera.width - 1 || v0 > camera.height - 1) return;
  }
  const int tile_columns = (camera.width + RANGE_TILE - 1) / RANGE_TILE;
  const int x0 = (int)fmax(u0, 0.0f) / RANGE_TILE, x1 = (int)fmin(u1 + 1.0f, camera.width - 1.0f) / RANGE_TILE;
  const int y0 = (int)fmax(v0, 0.0f) / RANGE_TILE, y1 = (int)fmin(v1 + 1.0f, camera.height - 1.0f) / RANGE_TILE;
  const int start = as_int(fmax(z0, min_range_m));
  const int end = as_int(fmin(z1, max_range_m));
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      const int tile = y * tile_columns + x;
      if (nearest[tile] > start) atomic_min(nearest + tile, start);
      if (farthest[tile] < end) atomic_max(farthest + tile, end);
    }
  }
}
