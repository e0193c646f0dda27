// Fuses a colour image into the voxels of the visible blocks that lie near the surface: a weighted average,
// by viewing angle, distance and quality of the pixel. A voxel takes the colour of the surface point next to
// it, which one Newton step along the distance's gradient finds, so that it sees the same point from
// everywhere. Work-items as in shared/block_items.h.
//   colors   of the pool (shared/color_map.h)
//   voxels   distances and certainties of the pool
//   visible  slots of the blocks; those no longer in use are left out
//   image    blue, green, red and quality a pixel (rate_pixels.cl)
//   depth_C  metres, what the colour camera sees; other surfaces are hidden. 0 = not known
//   T_C_W    of the colour camera as depth and calibration say, for depth_C and quality
//   T_A_W    of the colour camera where its colours fit the map's, for the colours
#include "shared/block_items.h"
#include "shared/color_map.h"
#include "shared/image.h"

#define BAND_VOX 1.5f      // half the thickness of the coloured layer
#define LEAST_COSINE 0.1f  // of the viewing angle
#define MOST_STRETCH 3.0f  // distances are measured along rays, which stretches them on slanting surfaces
#define MAX_FRAME_WEIGHT 16.0f

// Returns the slope of the distance along an axis, in steps a voxel, from voxels of the block: a central
// difference, or a one-sided one at the block's border and beside unknown voxels. `place` is the voxels'
// coordinate along the axis.
inline vfloat slope(__global const char* distances, vint voxel, vint place, int stride, vint centre) {
  const vint before = TO_VINT(GATHER(vchar, distances, select(voxel, voxel - stride, place > 0)));
  const vint after = TO_VINT(GATHER(vchar, distances, select(voxel, voxel + stride, place < BLOCK_SIZE - 1)));
  const vint lower = select(before, centre, before == TSDF_CHI);
  const vint upper = select(after, centre, after == TSDF_CHI);
  const vint both = (place > 0) & (before != TSDF_CHI) & (place < BLOCK_SIZE - 1) & (after != TSDF_CHI);
  return TO_VFLOAT(upper - lower) * select((vfloat)(1.0f), (vfloat)(0.5f), both);
}

// Holds points in the camera's frame and their pixels, which are valid where the camera sees them.
typedef struct {
  vfloat x, y, z, u, v;
  vint valid;
} Projections;

inline Projections project(vfloat x_W, vfloat y_W, vfloat z_W, const TransformArgs T_C_W,
                           const CameraArgs camera) {
  Projections p;
  p.x = rotated(T_C_W, 0, x_W, y_W, z_W) + T_C_W.translation[0];
  p.y = rotated(T_C_W, 1, x_W, y_W, z_W) + T_C_W.translation[1];
  p.z = rotated(T_C_W, 2, x_W, y_W, z_W) + T_C_W.translation[2];
  p.u = camera.fx * p.x / p.z + camera.cx;
  p.v = camera.fy * p.y / p.z + camera.cy;
  p.valid = (p.z > 0.0f) & (p.u >= 0.0f) & (p.u < camera.width - 1.0f) & (p.v >= 0.0f) &
            (p.v < camera.height - 1.0f);
  return p;
}

// Returns the cosine of the angle between gradient and ray; it is positive where the surface is seen from
// free space.
inline vfloat viewing_cosine(Projections p, vfloat gx, vfloat gy, vfloat gz, vfloat squared,
                             const TransformArgs T_C_W) {
  const vfloat towards = -(p.x * rotated(T_C_W, 0, gx, gy, gz) + p.y * rotated(T_C_W, 1, gx, gy, gz) +
                           p.z * rotated(T_C_W, 2, gx, gy, gz));
  return towards * rsqrt(squared * (p.x * p.x + p.y * p.y + p.z * p.z));
}

inline vfloat channel(vuint pixel, int shift) { return TO_VFLOAT(AS_VINT((pixel >> (uint)shift) & 255u)); }

// Interpolates one channel between four pixels.
inline vfloat between(vuint p00, vuint p10, vuint p01, vuint p11, int shift, vfloat fu, vfloat fv) {
  const vfloat upper = mix(channel(p00, shift), channel(p10, shift), fu);
  const vfloat lower = mix(channel(p01, shift), channel(p11, shift), fu);
  return mix(upper, lower, fv);
}

// Returns a byte of the new average; the random number makes rounding unbiased.
inline vuint averaged(vuint old, int shift, vfloat measured, vfloat gain, vfloat random) {
  const vfloat before = channel(old, shift);
  const vint rounded = TO_VINT(before + gain * (measured - before) + random);
  return AS_VUINT(clamp(rounded, (vint)(0), (vint)(255))) << (uint)shift;
}

__kernel void integrate_color(__global uint* colors, __global const char* voxels, __global const int* visible,
                              int visible_count, __global const int4* block_indices,
                              __global const int* block_states, __global const uint* image,
                              __global const float* depth_C, CameraArgs camera, TransformArgs T_C_W,
                              TransformArgs T_A_W, GridArgs grid, SensorArgs sensor, ColorFusionArgs args) {
  const int item = get_global_id(0);
  const int entry = item / ITEMS_PER_BLOCK;
  if (entry >= visible_count) return;
  const int slot = visible[entry];
  const int4 index = block_indices[slot];
  if (index.w == 0 || !(block_states[slot] & BLOCK_NEAR_SURFACE)) return;
  const int3 block = index.xyz;
  const int first_voxel = item % ITEMS_PER_BLOCK * ITEM_VOXELS;
  const float size = grid.voxel_size_m;
  __global const char* distances = voxels + block_distances(slot);
  __global uint* block_color = colors + block_colors(slot);
  const int band_steps = min((int)(MOST_STRETCH * BAND_VOX * TSDF_MAX * size / grid.truncation_m), TSDF_MAX);

  for (int first = first_voxel; first < first_voxel + ITEM_VOXELS; first += SIMD_WIDTH) {
    const vint distance = TO_VINT(VLOAD(distances + first));
    vint used = (distance >= -band_steps) & (distance <= band_steps);
    if (!ANY(used)) continue;
    const vint voxel = first + LANE_INDICES;
    const vint i = voxel & (BLOCK_SIZE - 1);
    const vint j = (voxel >> BLOCK_SIZE_LOG2) & (BLOCK_SIZE - 1);
    const vint k = voxel >> (2 * BLOCK_SIZE_LOG2);
    const vfloat gx = slope(distances, voxel, i, 1, distance);
    const vfloat gy = slope(distances, voxel, j, BLOCK_SIZE, distance);
    const vfloat gz = slope(distances, voxel, k, BLOCK_SIZE * BLOCK_SIZE, distance);
    const vfloat squared = gx * gx + gy * gy + gz * gz;
    const vfloat steps = TO_VFLOAT(distance);
    used = used & (squared > 1.0f) & (steps * steps <= BAND_VOX * BAND_VOX * squared);
    const vfloat step = steps / max(squared, 1.0f);
    const vfloat x_W = size * (TO_VFLOAT(i + block.x * BLOCK_SIZE) - step * gx);
    const vfloat y_W = size * (TO_VFLOAT(j + block.y * BLOCK_SIZE) - step * gy);
    const vfloat z_W = size * (TO_VFLOAT(k + block.z * BLOCK_SIZE) - step * gz);
    const Projections seen = project(x_W, y_W, z_W, T_C_W, camera);
    const Projections aligned = project(x_W, y_W, z_W, T_A_W, camera);
    const vfloat cosine = viewing_cosine(seen, gx, gy, gz, squared, T_C_W);
    used = used & seen.valid & aligned.valid & (cosine > LEAST_COSINE);
    if (!ANY(used)) continue;

    const vint nearest =
        select((vint)(0), pixel_indices(TO_VINT(seen.u + 0.5f), TO_VINT(seen.v + 0.5f), camera), used);
    const vfloat quality = TO_VFLOAT(AS_VINT(GATHER(vuint, image, nearest) >> 24));
    const vfloat measured_z = GATHER(vfloat, depth_C, nearest);
    const vfloat tolerance = args.hidden_m + args.hidden_sigmas * AXIAL_SIGMA_M(sensor, seen.z);
    used = used & ((measured_z == 0.0f) | (fabs(measured_z - seen.z) <= tolerance));
    const vuint old = VLOAD(block_color + first);
    const vfloat seen_weight = min(args.weight_at_1m * cosine * cosine / (seen.z * seen.z), MAX_FRAME_WEIGHT);
    const vfloat weight = select((vfloat)(0.0f), seen_weight * quality * (1.0f / 255.0f), used);
    const vfloat total = channel(old, 24) + weight;
    const vfloat gain = weight / max(total, 1e-6f);
    const vint u0 = TO_VINT(aligned.u);
    const vint v0 = TO_VINT(aligned.v);
    const vint corner = select((vint)(0), pixel_indices(u0, v0, camera), used);
    const vuint p00 = GATHER(vuint, image, corner);
    const vuint p10 = GATHER(vuint, image, corner + 1);
    const vuint p01 = GATHER(vuint, image, corner + camera.pitch);
    const vuint p11 = GATHER(vuint, image, corner + camera.pitch + 1);
    const vfloat fu = aligned.u - TO_VFLOAT(u0);
    const vfloat fv = aligned.v - TO_VFLOAT(v0);
    const vuint phase = dither_phase(first, block, args.frame) + AS_VUINT(LANE_INDICES) * DITHER_STEP;
    const vfloat random = TO_VFLOAT(AS_VINT(phase >> 8)) * (1.0f / 16777216.0f);
    vuint fused =
        averaged(old, 0, args.exposure_gain[0] * between(p00, p10, p01, p11, 0, fu, fv), gain, random);
    fused |= averaged(old, 8, args.exposure_gain[1] * between(p00, p10, p01, p11, 8, fu, fv), gain, random);
    fused |= averaged(old, 16, args.exposure_gain[2] * between(p00, p10, p01, p11, 16, fu, fv), gain, random);
    const vint new_weight = TO_VINT(min(total + (1.0f - random), args.max_weight));
    fused |= AS_VUINT(new_weight) << 24;
    VSTORE(select(old, fused, used), block_color + first);
  }
}
