// Follows rays through the block-sparse map to where the distance first goes from positive to negative. Rays
// are parametrised by depth t (z in frame D): p(t) = origin + t * direction, in voxels from the first voxel
// of the window, so that the conversion to integers, which truncates, rounds down.
#include "model_view/ray_ranges.h"
#include "shared/image.h"
#include "shared/window.h"
#define MAX_STEPS 512
#define MAX_MARCHES 4

typedef struct {
  vfloat direction_x, direction_y, direction_z;
  vfloat t_per_voxel;  // depth travelled in a voxel's length of the ray
} Rays;

typedef struct {
  float x, y, z;
} Point;

inline Point ray_origin(const TransformArgs T_W_D, const GridArgs grid) {
  const Point origin = {T_W_D.translation[0] / grid.voxel_size_m - grid.origin[0] * BLOCK_SIZE,
                        T_W_D.translation[1] / grid.voxel_size_m - grid.origin[1] * BLOCK_SIZE,
                        T_W_D.translation[2] / grid.voxel_size_m - grid.origin[2] * BLOCK_SIZE};
  return origin;
}

inline Rays make_rays(vint u, vint v, const CameraArgs camera, const TransformArgs T_W_D,
                      const GridArgs grid) {
  const float per_voxel = 1.0f / grid.voxel_size_m;
  const vfloat x = (TO_VFLOAT(u) - camera.cx) * (per_voxel / camera.fx);
  const vfloat y = (TO_VFLOAT(v) - camera.cy) * (per_voxel / camera.fy);
  Rays rays;
  rays.direction_x = rotated(T_W_D, 0, x, y, (vfloat)(per_voxel));
  rays.direction_y = rotated(T_W_D, 1, x, y, (vfloat)(per_voxel));
  rays.direction_z = rotated(T_W_D, 2, x, y, (vfloat)(per_voxel));
  rays.t_per_voxel = rsqrt(rays.direction_x * rays.direction_x + rays.direction_y * rays.direction_y +
                           rays.direction_z * rays.direction_z);
  return rays;
}

// Holds where the rays of a patch have come to.
typedef struct {
  Rays rays;
  ulong bins;  // where there may be a surface
  vfloat t, previous_t;
  vint previous;  // distance at previous_t
  vint active;
  vfloat hit_t;  // 0 = none
} March;

// Holds what the map has at t.
typedef struct {
  vint block_x, block_y, block_z;
  vint allocated;
  vint distance;
} Voxels;

// Starts those of `rays` that are `active` at the depth from which on their tiles have a surface.
inline March begin_march(const Rays rays, vint active, vfloat nearest_m, ulong bins,
                         const RayRangeArgs range) {
  March march;
  march.rays = rays;
  march.bins = bins;
  march.t = march.previous_t = nearest_m;
  march.previous = TSDF_CHI;
  march.active = active & (march.t < range.max_m);
  march.hit_t = 0.0f;
  return march;
}

// Looks up the voxels at t. `origin` is half a voxel ahead, for blocks hold the points that round to their
// voxels.
inline Voxels look(const March march, const Point origin, __global const int* offsets,
                   __global const char* voxels, const GridArgs grid) {
  const int n = grid.blocks_per_axis;
  const vint x = TO_VINT(origin.x + march.t * march.rays.direction_x);
  const vint y = TO_VINT(origin.y + march.t * march.rays.direction_y);
  const vint z = TO_VINT(origin.z + march.t * march.rays.direction_z);
  Voxels at;
  at.block_x = x >> BLOCK_SIZE_LOG2;
  at.block_y = y >> BLOCK_SIZE_LOG2;
  at.block_z = z >> BLOCK_SIZE_LOG2;
  const vint inside =
      march.active & in_window(at.block_x, n) & in_window(at.block_y, n) & in_window(at.block_z, n);
  const vint slot = slot_at(window_address(at.block_x, at.block_y, at.block_z, grid), inside, offsets);
  at.allocated = slot >= 0;
  const vint in_block = (x & (BLOCK_SIZE - 1)) + ((y & (BLOCK_SIZE - 1)) << BLOCK_SIZE_LOG2) +
                        ((z & (BLOCK_SIZE - 1)) << (2 * BLOCK_SIZE_LOG2));
  at.distance = select((vint)(TSDF_CHI), GATHER_BYTES(voxels, distances_of(slot) + in_block), at.allocated);
  return at;
}

// Returns the depth t at which a ray leaves a block along one axis.
inline vfloat exit_depth(vint block, float origin, vfloat direction) {
  const vint boundary = select(block, block + 1, direction > 0.0f) << BLOCK_SIZE_LOG2;
  return (TO_VFLOAT(boundary) - origin) / select(direction, (vfloat)(1e-9f), fabs(direction) < 1e-9f);
}

inline vfloat step_out_of_block(const March march, const Voxels at, const Point origin) {
  const vfloat exit_t = min(exit_depth(at.block_x, origin.x, march.rays.direction_x),
                            min(exit_depth(at.block_y, origin.y, march.rays.direction_y),
                                exit_depth(at.block_z, origin.z, march.rays.direction_z)));
  return max(exit_t, march.t) + 0.05f * march.rays.t_per_voxel;
}

// Steps as far as the distance says. Where the distance falls more slowly, the step goes a little beyond
// zero_t, where the distance would be zero.
inline vfloat step_in_band(const March march, vint distance, vfloat zero_t, float voxels_per_step) {
  const vfloat safe_t = march.t + fabs(TO_VFLOAT(distance)) * voxels_per_step * march.rays.t_per_voxel;
  const vint falling = (march.previous != TSDF_CHI) & (distance > 0) & (march.previous > distance);
  const vfloat ahead_t =
      select(safe_t, clamp(zero_t, safe_t, safe_t + 2.0f * march.rays.t_per_voxel), falling);
  return max(ahead_t + 0.25f * march.rays.t_per_voxel, march.t + march.rays.t_per_voxel);
}

inline void advance(March* march, const Voxels at, const Point origin, const GridArgs grid,
                    const RayRangeArgs range) {
  const float truncation_voxels = grid.truncation_m / grid.voxel_size_m;
  const float voxels_per_step = truncation_voxels / TSDF_MAX;
  const vfloat chi_step_t = march->rays.t_per_voxel * fmax(1.0f, 0.75f * truncation_voxels);
  const vint distance = at.distance;
  const vint known = distance != TSDF_CHI;

  // A step from an unknown voxel may end a little behind the surface: then the distance leads back. Farther
  // behind, the ray came from the surface's back.
  const vint behind = march->active & known & (distance <= 0);
  const vint crossed = behind & (march->previous > 0);
  const vint overshot = behind & (march->previous == TSDF_CHI) & (distance > -TSDF_MAX / 2);
  const vfloat zero_t = march->t + TO_VFLOAT(distance) * (march->t - march->previous_t) /
                                       TO_VFLOAT(max(march->previous - distance, (vint)(1)));
  march->hit_t = select(march->hit_t, zero_t, crossed);
  march->hit_t = select(march->hit_t,
                        march->t + TO_VFLOAT(distance) * voxels_per_step * march->rays.t_per_voxel, overshot);
  march->active = march->active & NOT(crossed | overshot);

  vfloat next_t =
      select(march->t + chi_step_t, step_in_band(*march, distance, zero_t, voxels_per_step), known);
  if (ANY(march->active & NOT(at.allocated))) {
    next_t = select(step_out_of_block(*march, at, origin), next_t, at.allocated);
    if (!ANY(march->active & at.allocated)) {
      const float least_t = LEAST(select((vfloat)(MAXFLOAT), next_t, march->active));
      next_t = max(next_t, next_occupied(march->bins, least_t, range));
    }
  }
  march->previous_t = march->t;
  march->previous = distance;
  march->t = next_t;
  march->active = march->active & (next_t < range.max_m);
}

// Follows the rays of up to MAX_MARCHES vectors to their crossings. While one vector waits for its voxels,
// the others go on.
inline void follow(March* marches, int count, const Point origin, __global const int* offsets,
                   __global const char* voxels, const GridArgs grid, const RayRangeArgs range) {
  const Point middle = {origin.x + 0.5f, origin.y + 0.5f, origin.z + 0.5f};
  vint active = -1;
  for (int step = 0; step < MAX_STEPS && ANY(active); ++step) {
    Voxels at[MAX_MARCHES];
    active = 0;
#pragma unroll
    for (int i = 0; i < count; ++i) {
      if (ANY(marches[i].active)) at[i] = look(marches[i], middle, offsets, voxels, grid);
    }
#pragma unroll
    for (int i = 0; i < count; ++i) {
      if (!ANY(marches[i].active)) continue;
      advance(&marches[i], at[i], middle, grid, range);
      active |= marches[i].active;
    }
  }
}
