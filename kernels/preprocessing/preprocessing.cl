// Converts depth images to clean depth in metres, pyramid and normals. Depth 0 = none. A work-item takes
// SIMD_WIDTH pixels of a row, or one tile (max_tiles).
#include "shared/image.h"
#include "shared/normal.h"

inline vfloat within_range(vfloat depth_m, vint x, const CameraArgs camera, const RangeArgs range) {
  const vint good = (depth_m >= range.min_range_m) & (depth_m <= range.max_range_m) & (x < camera.width);
  return select((vfloat)(0.0f), depth_m, good);
}

// Takes the sensor's systematic error out, if the program is built with -DCORRECTED.
inline vfloat corrected(vfloat depth_m, __global const float* offsets) {
#ifdef CORRECTED
  return depth_m / (1.0f + depth_m * VLOAD(offsets));
#else
  return depth_m;
#endif
}

// `input` holds width * height values without padding, and SIMD_WIDTH more of any kind. `offsets` is an image
// of what the inverse depth lacks; it is read with -DCORRECTED.
__kernel void depth_to_metres_u16(__global const ushort* input, __global const float* offsets,
                                  __global float* depth, CameraArgs camera, RangeArgs range) {
  const int x = get_global_id(0) * SIMD_WIDTH;
  const int y = get_global_id(1);
  if (x >= camera.width) return;
  const int index = pixel_index(x, y, camera);
  const vfloat value =
      corrected(TO_VFLOAT(VLOAD(input + y * camera.width + x)) * range.unit_m, offsets + index);
  VSTORE(within_range(value, x + LANE_INDICES, camera, range), depth + index);
}

__kernel void depth_to_metres_f32(__global const float* input, __global const float* offsets,
                                  __global float* depth, CameraArgs camera, RangeArgs range) {
  const int x = get_global_id(0) * SIMD_WIDTH;
  const int y = get_global_id(1);
  if (x >= camera.width) return;
  const int index = pixel_index(x, y, camera);
  const vfloat value = corrected(VLOAD(input + y * camera.width + x) * range.unit_m, offsets + index);
  VSTORE(within_range(value, x + LANE_INDICES, camera, range), depth + index);
}

// Averages neighbours in a 5x5 window, weighted by distance in the image and, with Tukey's biweight, in
// depth.
__kernel void filter_bilateral(__global const float* depth, __global float* filtered, CameraArgs camera,
                               SensorArgs sensor, BilateralArgs args) {
  const int x = get_global_id(0) * SIMD_WIDTH;
  const int y = get_global_id(1);
  if (x >= camera.width) return;
  const vfloat centre = VLOAD(depth + pixel_index(x, y, camera));
  const vfloat cutoff_m = args.cutoff_sigmas * AXIAL_SIGMA_M(sensor, centre);
  const vfloat scale = 1.0f / (cutoff_m * cutoff_m);
  vfloat sum = 0.0f;
  vfloat weights = 0.0f;
  for (int dy = max(-2, -y); dy <= min(2, camera.height - 1 - y); ++dy) {
    __global const float* row = depth + pixel_index(x, y + dy, camera);
    for (int dx = -2; dx <= 2; ++dx) {
      const vfloat neighbour = VLOAD(row + dx);
      const vfloat difference = neighbour - centre;
      const vfloat similarity = max(1.0f - difference * difference * scale, (vfloat)(0.0f));
      const vfloat weight =
          args.spatial_weights[abs(dx)] * args.spatial_weights[abs(dy)] * similarity * similarity;
      sum += weight * neighbour;
      weights += weight;
    }
  }
  VSTORE(select((vfloat)(0.0f), sum / weights, centre > 0.0f), filtered + pixel_index(x, y, camera));
}

// Computes pixels of the image of half the size: the mean of those of a pixel's 2x2 that lie near the closest
// one.
__kernel void halve_depth(__global const float* depth, __global float* half_depth, CameraArgs camera,
                          CameraArgs half_camera, SensorArgs sensor, float cutoff_sigmas) {
  const int x = get_global_id(0) * SIMD_WIDTH;
  const int y = get_global_id(1);
  if (x >= half_camera.width) return;
  vfloat four[4];
  for (int i = 0; i < 2; ++i) {
    __global const float* row = depth + pixel_index(2 * x, 2 * y + i, camera);
    const vfloat first = VLOAD(row), second = VLOAD(row + SIMD_WIDTH);
    four[2 * i] = EVEN_LANES(first, second);
    four[2 * i + 1] = ODD_LANES(first, second);
  }
  vfloat closest = MAXFLOAT;
  for (int i = 0; i < 4; ++i) closest = select(closest, min(closest, four[i]), four[i] > 0.0f);
  const vfloat limit = closest + cutoff_sigmas * AXIAL_SIGMA_M(sensor, closest);
  vfloat sum = 0.0f, count = 0.0f;
  for (int i = 0; i < 4; ++i) {
    const vint counts = (four[i] > 0.0f) & (four[i] <= limit);
    sum += select((vfloat)(0.0f), four[i], counts);
    count += select((vfloat)(0.0f), (vfloat)(1.0f), counts);
  }
  const vint some = (count > 0.0f) & (x + LANE_INDICES < half_camera.width);
  VSTORE(select((vfloat)(0.0f), sum / count, some), half_depth + pixel_index(x, y, half_camera));
}

// Computes unit normals towards the camera from a plane fitted to the depth's 3x3 neighbours NORMAL_STEP
// pixels apart; a normal is 0 where a neighbour is missing or the depth jumps.
#define NORMAL_STEP 2
__kernel void compute_normals(__global const float* depth, __global uint* normals, CameraArgs camera,
                              float max_relative_step) {
  const int x = get_global_id(0) * SIMD_WIDTH;
  const int y = get_global_id(1);
  if (x >= camera.width) return;
  const int index = pixel_index(x, y, camera);
  vuint normal = 0;
  if (y >= NORMAL_STEP && y < camera.height - NORMAL_STEP) {
    const vfloat z = VLOAD(depth + index);
    const vfloat limit = max_relative_step * z;
    vint good = z > 0.0f;
    vfloat dz_du = 0.0f, dz_dv = 0.0f;
    for (int dv = -1; dv <= 1; ++dv) {
      for (int du = -1; du <= 1; ++du) {
        const vfloat neighbour = VLOAD(depth + index + NORMAL_STEP * (dv * camera.pitch + du));
        good = good & (fabs(neighbour - z) < limit);
        dz_du += du * neighbour;
        dz_dv += dv * neighbour;
      }
    }
    dz_du *= 1.0f / (6 * NORMAL_STEP);
    dz_dv *= 1.0f / (6 * NORMAL_STEP);
    const vfloat u = TO_VFLOAT(x + LANE_INDICES) - camera.cx;
    const float v = (float)y - camera.cy;
    const vuint fitted = pack_normals(camera.fx * dz_du, camera.fy * dz_dv, -(z + u * dz_du + v * dz_dv));
    normal = select(normal, fitted, AS_VUINT(good));
  }
  VSTORE(normal, normals + index);
}

// Finds the largest depth of each 8x8 tile.
__kernel void max_tiles(__global const float* depth, __global float* tiles, CameraArgs camera,
                        int tile_columns, int tile_count) {
  const int tile = get_global_id(0);
  if (tile >= tile_count) return;
  const int x = (tile % tile_columns) * DEPTH_TILE;
  const int y = (tile / tile_columns) * DEPTH_TILE;
  float8 largest = 0.0f;
  for (int row = y; row < min(y + DEPTH_TILE, camera.height); ++row) {
    largest = fmax(largest, vload8(0, depth + pixel_index(x, row, camera)));
  }
  const float4 a = fmax(largest.lo, largest.hi);
  tiles[tile] = fmax(fmax(a.x, a.y), fmax(a.z, a.w));
}
