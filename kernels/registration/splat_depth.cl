// Moves depth to another camera, nearest first. Images as in shared/types.h.
//   depth    of the depth camera, metres, 0 = none
//   depth_C  of the other camera, metres
#include "shared/image.h"

// A work-item moves one pixel of the depth camera to the other, where it covers footprint x footprint pixels;
// the nearest wins. depth_C: float bits, NO_DEPTH_BITS before.
__kernel void splat_depth(__global const float* depth, __global int* depth_C, CameraArgs camera,
                          CameraArgs other_camera, TransformArgs T_C_D, int footprint) {
  const int x = get_global_id(0);
  const int y = get_global_id(1);
  if (x >= camera.width) return;
  const float z = depth[pixel_index(x, y, camera)];
  if (!(z > 0.0f)) return;
  const float3 p_D = z * (float3)((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1.0f);
  const float3 p_C = transform_point(T_C_D, p_D);
  if (!(p_C.z > 0.0f)) return;
  const float beside = 0.5f * (footprint - 1);
  const int u = convert_int_sat_rte(other_camera.fx * p_C.x / p_C.z + other_camera.cx - beside);
  const int v = convert_int_sat_rte(other_camera.fy * p_C.y / p_C.z + other_camera.cy - beside);
  for (int row = max(v, 0); row < min(v + footprint, other_camera.height); ++row) {
    for (int column = max(u, 0); column < min(u + footprint, other_camera.width); ++column) {
      atomic_min(depth_C + pixel_index(column, row, other_camera), as_int(p_C.z));
    }
  }
}

// A work-item tests one element of the image.
__kernel void drop_unset_depth(__global int* depth_C, int elements) {
  const int i = get_global_id(0);
  if (i < elements && depth_C[i] == NO_DEPTH_BITS) depth_C[i] = 0;
}
