// Where the rays of each tile of the view can hit, by the octants of blocks that are near the surface. A
// work-item projects those of a slot of the groups in view, an octant a lane.
#include "model_view/ray_ranges.h"
#include "shared/block_map.h"
#include "shared/image.h"

// Each octant lies on these sides of the block's middle.
#define SIDE_X ((float8)(-1, 1, -1, 1, -1, 1, -1, 1))
#define SIDE_Y ((float8)(-1, -1, 1, 1, -1, -1, 1, 1))
#define SIDE_Z ((float8)(-1, -1, -1, -1, 1, 1, 1, 1))

// Holds what octants cover, in metres or in pixels along one axis of the image.
typedef struct {
  float8 lowest, highest;
} Extents;

// The pixels that boxes along the axes of frame D cover. A box that reaches behind the camera covers what its
// part ahead of it covers.
inline Extents pixel_extents(float8 centre, float reach, const Extents depth, float focal_length,
                             float image_centre) {
  const float8 near = focal_length / max(depth.lowest, (float8)(1e-3f)), far = focal_length / depth.highest;
  const float8 lowest = centre - reach, highest = centre + reach;
  const Extents pixels = {min(lowest * near, lowest * far) + image_centre,
                          max(highest * near, highest * far) + image_centre};
  return pixels;
}

inline int8 in_image(const Extents pixels, int size) {
  return (pixels.highest >= 0.0f) & (pixels.lowest <= size - 1);
}

inline int8 tile_at(float8 pixel, int size) {
  return convert_int8(clamp(pixel, (float8)(0.0f), (float8)(size - 1.0f))) / RANGE_TILE;
}

// Adds a range to a tile's.
inline void widen(int tile, float start, ulong bins, __global int* nearest, __global uint* occupied) {
  if (nearest[tile] > as_int(start)) atomic_min(nearest + tile, as_int(start));
  const uint low = (uint)bins, high = (uint)(bins >> 32);
  if (low & ~occupied[2 * tile]) atomic_or(occupied + 2 * tile, low);
  if (high & ~occupied[2 * tile + 1]) atomic_or(occupied + 2 * tile + 1, high);
}

__kernel void splat_block_ranges(__global const int* groups, int group_count, int slots,
                                 __global const int4* block_indices, __global const int* block_states,
                                 __global int* nearest, __global uint* occupied, CameraArgs camera,
                                 TransformArgs T_D_W, GridArgs grid, RayRangeArgs range) {
  const int slot = slot_in_view(groups, group_count, slots);
  if (slot < 0) return;
  const int4 index = block_indices[slot];
  const int octants = (block_states[slot] & BLOCK_NEAR_SURFACE) >> BLOCK_NEAR_SURFACE_SHIFT;
  if (index.w == 0 || octants == 0) return;
  const float quarter_m = 0.25f * grid.voxel_size_m * BLOCK_SIZE;
  const float3 middle = transform_point(T_D_W, (convert_float3(index.xyz) + 0.5f) * (4.0f * quarter_m));
  const float3 axis_x = quarter_m * (float3)(T_D_W.rotation[0], T_D_W.rotation[3], T_D_W.rotation[6]);
  const float3 axis_y = quarter_m * (float3)(T_D_W.rotation[1], T_D_W.rotation[4], T_D_W.rotation[7]);
  const float3 axis_z = quarter_m * (float3)(T_D_W.rotation[2], T_D_W.rotation[5], T_D_W.rotation[8]);
  const float3 reach = fabs(axis_x) + fabs(axis_y) + fabs(axis_z);
  if (!sphere_in_view(middle, 2.0f * 1.7320508f * quarter_m, camera)) return;
  if (middle.z + 2.0f * reach.z < range.min_m || middle.z - 2.0f * reach.z > range.max_m) return;

  const float8 x = middle.x + SIDE_X * axis_x.x + SIDE_Y * axis_y.x + SIDE_Z * axis_z.x;
  const float8 y = middle.y + SIDE_X * axis_x.y + SIDE_Y * axis_y.y + SIDE_Z * axis_z.y;
  const float8 z = middle.z + SIDE_X * axis_x.z + SIDE_Y * axis_y.z + SIDE_Z * axis_z.z;
  const Extents depth = {z - reach.z, z + reach.z};
  const Extents u = pixel_extents(x, reach.x, depth, camera.fx, camera.cx);
  const Extents v = pixel_extents(y, reach.y, depth, camera.fy, camera.cy);
  const float8 start = max(depth.lowest, (float8)(range.min_m)),
               end = min(depth.highest, (float8)(range.max_m));
  const int8 seen = (start <= end) & in_image(u, camera.width) & in_image(v, camera.height);

  float starts[8], ends[8];
  int is_seen[8], left[8], right[8], top[8], bottom[8];
  vstore8(start, 0, starts);
  vstore8(end, 0, ends);
  vstore8(seen, 0, is_seen);
  vstore8(tile_at(u.lowest, camera.width), 0, left);
  vstore8(tile_at(u.highest + 1.0f, camera.width), 0, right);
  vstore8(tile_at(v.lowest, camera.height), 0, top);
  vstore8(tile_at(v.highest + 1.0f, camera.height), 0, bottom);
  for (int i = 0; i < 8; ++i) {
    if (!(octants >> i & 1) || !is_seen[i]) continue;
    const int first_bin = depth_bin(starts[i], range);
    const ulong bins = ((2ul << (depth_bin(ends[i], range) - first_bin)) - 1) << first_bin;
    for (int row = top[i]; row <= bottom[i]; ++row) {
      const int first_tile = row * tiles_across(camera.width);
      for (int column = left[i]; column <= right[i]; ++column) {
        widen(first_tile + column, starts[i], bins, nearest, occupied);
      }
    }
  }
}
