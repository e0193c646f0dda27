// Moves depth to another camera, nearest first. Images as in shared/types.h.
//   depth    of the depth camera, metres, 0 = none
//   depth_C  of the other camera, metres
#include "shared/image.h"

// A work-item moves SIMD_WIDTH pixels of a row of the depth camera to the other, where each covers footprint
// x footprint pixels; the nearest wins. depth_C: float bits, NO_DEPTH_BITS before.
__kernel void splat_depth(__global const float* depth, __global int* depth_C, CameraArgs camera,
                          CameraArgs other_camera, TransformArgs T_C_D, int footprint) {
  const int x = get_global_id(0) * SIMD_WIDTH;
  const int y = get_global_id(1);
  if (x >= camera.width) return;
  const vfloat z = VLOAD(depth + pixel_index(x, y, camera));
  const vfloat x_D = z * (TO_VFLOAT(x + LANE_INDICES) - camera.cx) / camera.fx;
  const vfloat y_D = z * ((y - camera.cy) / camera.fy);
  const vfloat z_C = rotated(T_C_D, 2, x_D, y_D, z) + T_C_D.translation[2];
  const vint good = (z > 0.0f) & (z_C > 0.0f);
  if (!ANY(good)) return;
  const float beside = 0.5f * (footprint - 1);
  const vfloat u = other_camera.fx * (rotated(T_C_D, 0, x_D, y_D, z) + T_C_D.translation[0]) / z_C +
                   other_camera.cx - beside;
  const vfloat v = other_camera.fy * (rotated(T_C_D, 1, x_D, y_D, z) + T_C_D.translation[1]) / z_C +
                   other_camera.cy - beside;
  // Far outside, integers would not hold them.
  int columns[SIMD_WIDTH], rows[SIMD_WIDTH], bits[SIMD_WIDTH];
  VSTORE(TO_VINT(rint(clamp(u, -(float)footprint, (float)other_camera.width))), columns);
  VSTORE(TO_VINT(rint(clamp(v, -(float)footprint, (float)other_camera.height))), rows);
  VSTORE(select((vint)(NO_DEPTH_BITS), AS_VINT(z_C), good), bits);
  for (int lane = 0; lane < SIMD_WIDTH; ++lane) {
    if (bits[lane] == NO_DEPTH_BITS) continue;
    const int bottom = min(rows[lane] + footprint, other_camera.height);
    const int right = min(columns[lane] + footprint, other_camera.width);
    for (int row = max(rows[lane], 0); row < bottom; ++row) {
      for (int column = max(columns[lane], 0); column < right; ++column) {
        atomic_min(depth_C + pixel_index(column, row, other_camera), bits[lane]);
      }
    }
  }
}

// A work-item tests one element of the image.
__kernel void drop_unset_depth(__global int* depth_C, int elements) {
  const int i = get_global_id(0);
  if (i < elements && depth_C[i] == NO_DEPTH_BITS) depth_C[i] = 0;
}
