// Ray casting of the block-sparse map in two stages, as the paper has it: raycast_coarse finds the voxel where a ray
// first goes from positive to negative distance, raycast_fine the surface in it by trilinear interpolation, and its
// normal. Rays are parametrised by depth t (z in frame D): p(t) = origin + t * direction, in voxels from the first voxel
// of the window, so that the conversion to integers, which truncates, rounds down. A work-item casts SIMD_WIDTH rays: of a
// patch in raycast_coarse, for rays side by side in both axes end alike, and of a row in raycast_fine.
#include "shared/block_map.h"
#include "shared/image.h"
#define MAX_STEPS 512
#define PATCH_COLUMNS RAY_PATCH_COLUMNS(SIMD_WIDTH)

typedef struct {
  float origin_x, origin_y, origin_z;
  vfloat direction_x, direction_y, direction_z;
  vfloat t_per_voxel;  // depth travelled in a voxel's length of the ray
} Rays;

inline Rays make_rays(vint u, vint v, const CameraArgs camera, const TransformArgs T_W_D, const GridArgs grid) {
  const float per_voxel = 1.0f / grid.voxel_size_m;
  const vfloat x = (TO_VFLOAT(u) - camera.cx) * (per_voxel / camera.fx);
  const vfloat y = (TO_VFLOAT(v) - camera.cy) * (per_voxel / camera.fy);
  const float z = per_voxel;
  Rays rays;
  rays.origin_x = T_W_D.translation[0] * per_voxel - grid.origin[0] * BLOCK_SIZE;
  rays.origin_y = T_W_D.translation[1] * per_voxel - grid.origin[1] * BLOCK_SIZE;
  rays.origin_z = T_W_D.translation[2] * per_voxel - grid.origin[2] * BLOCK_SIZE;
  rays.direction_x = T_W_D.rotation[0] * x + (T_W_D.rotation[1] * y + T_W_D.rotation[2] * z);
  rays.direction_y = T_W_D.rotation[3] * x + (T_W_D.rotation[4] * y + T_W_D.rotation[5] * z);
  rays.direction_z = T_W_D.rotation[6] * x + (T_W_D.rotation[7] * y + T_W_D.rotation[8] * z);
  rays.t_per_voxel = rsqrt(rays.direction_x * rays.direction_x + rays.direction_y * rays.direction_y +
                           rays.direction_z * rays.direction_z);
  return rays;
}

// 1 / direction, large but finite for a ray across the axis.
inline vfloat inverse_direction(vfloat direction) {
  return 1.0f / select(direction, (vfloat)(1e-9f), fabs(direction) < 1e-9f);
}

// Depth t at which a ray leaves a block along one axis.
inline vfloat exit_depth(vint block, float origin, vfloat inverse) {
  const vint boundary = select(block, block + 1, inverse > 0.0f) << BLOCK_SIZE_LOG2;
  return (TO_VFLOAT(boundary) - origin) * inverse;
}

// Wraps block coordinates of the window, already in it, to the coordinates of its offsets.
inline vint wrap(vint block, int wrapped_origin, int blocks_per_axis) {
  const vint wrapped = block + wrapped_origin;
  return select(wrapped, wrapped - blocks_per_axis, wrapped >= blocks_per_axis);
}

inline vint in_window(vint block, int blocks_per_axis) { return AS_VUINT(block) < (uint)blocks_per_axis; }

// coarse: depth of the hit in metres a pixel, 0 = none
__kernel void raycast_coarse(__global const int *offsets, __global const char *voxels, __global const float *nearest,
                             __global const float *farthest, __global float *coarse, CameraArgs camera,
                             TransformArgs T_W_D, GridArgs grid) {
  const int x = get_global_id(0) * PATCH_COLUMNS;
  const int y = get_global_id(1) * (SIMD_WIDTH / PATCH_COLUMNS);
  if (x >= camera.width || y >= camera.height) return;
  const vint u = x + LANE_INDICES % PATCH_COLUMNS;
  const vint v = y + LANE_INDICES / PATCH_COLUMNS;
  const Rays rays = make_rays(u, v, camera, T_W_D, grid);
  // blocks hold the points that round to their voxels
  const float origin_x = rays.origin_x + 0.5f, origin_y = rays.origin_y + 0.5f, origin_z = rays.origin_z + 0.5f;
  const vfloat inverse_x = inverse_direction(rays.direction_x);
  const vfloat inverse_y = inverse_direction(rays.direction_y);
  const vfloat inverse_z = inverse_direction(rays.direction_z);
  const int n = grid.blocks_per_axis;
  const int tile = y / RANGE_TILE * ((camera.width + RANGE_TILE - 1) / RANGE_TILE) + x / RANGE_TILE;
  const vfloat end = farthest[tile];
  vfloat t = nearest[tile];
  const float truncation_voxels = grid.truncation_m / grid.voxel_size_m;
  const vfloat t_per_step = rays.t_per_voxel * (truncation_voxels / TSDF_MAX);
  const vfloat chi_step_t = rays.t_per_voxel * fmax(1.0f, 0.75f * truncation_voxels);

  vfloat hit_t = 0.0f;
  vfloat previous_t = t;
  vint previous = TSDF_CHI;
  vint active = (t < end) & (u < camera.width);
  for (int i = 0; i < MAX_STEPS && ANY(active); ++i) {
    const vint vx = TO_VINT(origin_x + t * rays.direction_x);
    const vint vy = TO_VINT(origin_y + t * rays.direction_y);
    const vint vz = TO_VINT(origin_z + t * rays.direction_z);
    const vint bx = vx >> BLOCK_SIZE_LOG2;
    const vint by = vy >> BLOCK_SIZE_LOG2;
    const vint bz = vz >> BLOCK_SIZE_LOG2;
    const vint inside = active & in_window(bx, n) & in_window(by, n) & in_window(bz, n);
    const vint address = wrap(bx, grid.wrapped_origin[0], n) +
                         n * (wrap(by, grid.wrapped_origin[1], n) + n * wrap(bz, grid.wrapped_origin[2], n));
    const vint slot = select((vint)(-1), GATHER(vint, offsets, select((vint)(0), address, inside)), inside);
    const vint allocated = slot >= 0;
    const vint in_block = (vx & (BLOCK_SIZE - 1)) + ((vy & (BLOCK_SIZE - 1)) << BLOCK_SIZE_LOG2) +
                          ((vz & (BLOCK_SIZE - 1)) << (2 * BLOCK_SIZE_LOG2));
    const vint voxel = select((vint)(0), slot * (2 * BLOCK_VOXELS) + in_block, allocated);
    const vint distance = select((vint)(TSDF_CHI), TO_VINT(GATHER(vchar, voxels, voxel)), allocated);
    const vint known = distance != TSDF_CHI;

    // A step from an unknown voxel may end a little behind the surface: then the distance leads back. Farther behind,
    // the ray came from the surface's back.
    const vint behind = active & known & (distance <= 0);
    const vint crossed = behind & (previous > 0);
    const vint overshot = behind & (previous == TSDF_CHI) & (distance > -TSDF_MAX / 2);
    const vfloat fraction = TO_VFLOAT(previous) / TO_VFLOAT(max(previous - distance, (vint)(1)));
    const vfloat steps = TO_VFLOAT(distance);
    hit_t = select(hit_t, previous_t + (t - previous_t) * fraction, crossed);
    hit_t = select(hit_t, t + steps * t_per_step, overshot);
    active = active & NOT(crossed | overshot);

    previous_t = t;
    previous = distance;
    const vfloat near_step_t = max(0.8f * fabs(steps) * t_per_step, rays.t_per_voxel);
    vfloat next_t = t + select(chi_step_t, near_step_t, known);
    if (ANY(active & NOT(allocated))) {
      const vfloat exit = min(exit_depth(bx, origin_x, inverse_x),
                              min(exit_depth(by, origin_y, inverse_y), exit_depth(bz, origin_z, inverse_z)));
      next_t = select(max(exit, t) + 0.05f * rays.t_per_voxel, next_t, allocated);
    }
    t = next_t;
    active = active & (t < end);
  }
  float lanes[SIMD_WIDTH];
  VSTORE(hit_t, lanes);
  for (int i = 0; i < SIMD_WIDTH; ++i) {
    const int row = y + i / PATCH_COLUMNS;
    if (row < camera.height) coarse[pixel_index(x + i % PATCH_COLUMNS, row, camera)] = lanes[i];
  }
}

// Offsets, along one axis, of the two voxels around a coordinate: of their blocks in the window (or outside), and in
// their blocks.
typedef struct {
  vint block[2], in_block[2], inside[2];
} AxisNeighbours;

inline AxisNeighbours axis_neighbours(vint voxel, int axis, const GridArgs grid) {
  AxisNeighbours result;
  for (int i = 0; i < 2; ++i) {
    const vint v = voxel + i;
    const vint block = v >> BLOCK_SIZE_LOG2;
    result.inside[i] = in_window(block, grid.blocks_per_axis);
    result.block[i] = wrap(block, grid.wrapped_origin[axis], grid.blocks_per_axis);
    result.in_block[i] = v & (BLOCK_SIZE - 1);
  }
  return result;
}

// Trilinear interpolation of the distance at p, in steps of the distance byte, and its gradient in steps a voxel.
// known: 0 where one of the eight voxels is chi.
typedef struct {
  vfloat value, gradient_x, gradient_y, gradient_z;
  vint known;
} Sample;

inline Sample interpolate(vfloat px, vfloat py, vfloat pz, vint active, __global const int *offsets,
                          __global const char *voxels, const GridArgs grid) {
  const vint vx = TO_VINT(px), vy = TO_VINT(py), vz = TO_VINT(pz);
  const AxisNeighbours nx = axis_neighbours(vx, 0, grid);
  const AxisNeighbours ny = axis_neighbours(vy, 1, grid);
  const AxisNeighbours nz = axis_neighbours(vz, 2, grid);
  const int n = grid.blocks_per_axis;
  Sample sample;
  sample.known = active;
  vfloat corner[8];
  for (int i = 0; i < 8; ++i) {
    const int cx = i & 1, cy = (i >> 1) & 1, cz = i >> 2;
    const vint inside = sample.known & nx.inside[cx] & ny.inside[cy] & nz.inside[cz];
    const vint address = select((vint)(0), nx.block[cx] + n * (ny.block[cy] + n * nz.block[cz]), inside);
    const vint slot = select((vint)(-1), GATHER(vint, offsets, address), inside);
    const vint in_block =
        nx.in_block[cx] + (ny.in_block[cy] << BLOCK_SIZE_LOG2) + (nz.in_block[cz] << (2 * BLOCK_SIZE_LOG2));
    const vint allocated = slot >= 0;
    const vint voxel = select((vint)(0), slot * (2 * BLOCK_VOXELS) + in_block, allocated);
    const vint distance = TO_VINT(GATHER(vchar, voxels, voxel));
    sample.known = inside & allocated & (distance != TSDF_CHI);
    corner[i] = TO_VFLOAT(distance);
  }
  const vfloat x = px - TO_VFLOAT(vx), y = py - TO_VFLOAT(vy), z = pz - TO_VFLOAT(vz);
  const vfloat x00 = corner[1] - corner[0], x10 = corner[3] - corner[2];
  const vfloat x01 = corner[5] - corner[4], x11 = corner[7] - corner[6];
  const vfloat v00 = corner[0] + x * x00, v10 = corner[2] + x * x10;
  const vfloat v01 = corner[4] + x * x01, v11 = corner[6] + x * x11;
  const vfloat v0 = v00 + y * (v10 - v00), v1 = v01 + y * (v11 - v01);
  const vfloat gx0 = x00 + y * (x10 - x00), gx1 = x01 + y * (x11 - x01);
  sample.value = v0 + z * (v1 - v0);
  sample.gradient_x = gx0 + z * (gx1 - gx0);
  sample.gradient_y = (v10 - v00) + z * ((v11 - v01) - (v10 - v00));
  sample.gradient_z = v1 - v0;
  return sample;
}

// depth: metres, 0 = none; normals: three planes of `plane` elements, unit, towards free space, in frame D
__kernel void raycast_fine(__global const int *offsets, __global const char *voxels, __global const float *coarse,
                           __global float *depth, __global float *normals, int plane, CameraArgs camera,
                           TransformArgs T_W_D, GridArgs grid) {
  const int x = get_global_id(0) * SIMD_WIDTH;
  const int y = get_global_id(1);
  if (x >= camera.width) return;
  const int index = pixel_index(x, y, camera);
  const Rays rays = make_rays(x + LANE_INDICES, (vint)(y), camera, T_W_D, grid);
  vfloat t = VLOAD(coarse + index);
  const Sample sample = interpolate(rays.origin_x + t * rays.direction_x, rays.origin_y + t * rays.direction_y,
                                    rays.origin_z + t * rays.direction_z, t > 0.0f, offsets, voxels, grid);
  const vfloat gx = sample.gradient_x, gy = sample.gradient_y, gz = sample.gradient_z;
  const vfloat slope = gx * rays.direction_x + gy * rays.direction_y + gz * rays.direction_z;
  const vint known = sample.known & (slope < 0.0f);
  // one Newton step; the coarse hit is less than a voxel away
  const vfloat limit = 1.5f * rays.t_per_voxel;
  t -= clamp(sample.value / slope, -limit, limit);
  const vfloat scale = rsqrt(gx * gx + gy * gy + gz * gz);
  // frame D: the rotation's transpose
  const vfloat nx = T_W_D.rotation[0] * gx + T_W_D.rotation[3] * gy + T_W_D.rotation[6] * gz;
  const vfloat ny = T_W_D.rotation[1] * gx + T_W_D.rotation[4] * gy + T_W_D.rotation[7] * gz;
  const vfloat nz = T_W_D.rotation[2] * gx + T_W_D.rotation[5] * gy + T_W_D.rotation[8] * gz;
  VSTORE(select((vfloat)(0.0f), t, known), depth + index);
  VSTORE(select((vfloat)(0.0f), nx * scale, known), normals + index);
  VSTORE(select((vfloat)(0.0f), ny * scale, known), normals + index + plane);
  VSTORE(select((vfloat)(0.0f), nz * scale, known), normals + index + 2 * plane);
}
