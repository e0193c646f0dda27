// The colour camera's depth and the quality of its pixels. Images as in shared/types.h.
//   depth    of the depth camera, metres, 0 = none
//   depth_C  of the colour camera, metres
#include "shared/image.h"

// A work-item moves one pixel of the depth camera to the colour camera, where it covers footprint x footprint pixels;
// the nearest wins. depth_C: float bits, NO_DEPTH_BITS before.
__kernel void splat_depth(__global const float *depth, __global int *depth_C, CameraArgs camera,
                          CameraArgs color_camera, TransformArgs T_C_D, int footprint) {
  const int x = get_global_id(0);
  const int y = get_global_id(1);
  if (x >= camera.width) return;
  const float z = depth[pixel_index(x, y, camera)];
  if (!(z > 0.0f)) return;
  const float3 p_D = z * (float3)((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1.0f);
  const float3 p_C = transform_point(T_C_D, p_D);
  if (!(p_C.z > 0.0f)) return;
  const float beside = 0.5f * (footprint - 1);
  const int u = convert_int_sat_rte(color_camera.fx * p_C.x / p_C.z + color_camera.cx - beside);
  const int v = convert_int_sat_rte(color_camera.fy * p_C.y / p_C.z + color_camera.cy - beside);
  for (int row = max(v, 0); row < min(v + footprint, color_camera.height); ++row) {
    for (int column = max(u, 0); column < min(u + footprint, color_camera.width); ++column) {
      atomic_min(depth_C + pixel_index(column, row, color_camera), as_int(p_C.z));
    }
  }
}

// A work-item tests one element of the image.
__kernel void drop_unset_depth(__global int *depth_C, int elements) {
  const int i = get_global_id(0);
  if (i < elements && depth_C[i] == NO_DEPTH_BITS) depth_C[i] = 0;
}

// Sets the highest byte of each pixel of the image to how far its colour can be trusted: little beside a depth edge,
// where depth and colour disagree about which side a pixel is on, where there is no depth, and where the sensor is
// overexposed. A work-item takes SIMD_WIDTH pixels of a row.
#define EDGE_RADIUS 4
#define EDGE_SPACING 2
__kernel void rate_pixels(__global uint *image, __global const float *depth_C, CameraArgs camera,
                          float max_relative_step) {
  const int x = get_global_id(0) * SIMD_WIDTH;
  const int y = get_global_id(1);
  if (x >= camera.width) return;
  const int index = pixel_index(x, y, camera);
  const vfloat z = VLOAD(depth_C + index);
  const vfloat limit = max_relative_step * z;
  vfloat nearest_edge = EDGE_RADIUS + 1;
  for (int dy = -EDGE_RADIUS; dy <= EDGE_RADIUS; dy += EDGE_SPACING) {
    const int row = clamp(y + dy, 0, camera.height - 1);
    for (int dx = -EDGE_RADIUS; dx <= EDGE_RADIUS; dx += EDGE_SPACING) {
      const vfloat neighbour = VLOAD(depth_C + pixel_index(x + dx, row, camera));
      const float distance = max(abs(dx), abs(dy));
      nearest_edge = select(nearest_edge, min(nearest_edge, (vfloat)(distance)), fabs(neighbour - z) > limit);
    }
  }
  const vuint pixel = VLOAD(image + index) & 0xffffffu;
  const vuint brightest = max(max(pixel & 255u, (pixel >> 8) & 255u), pixel >> 16);
  vfloat quality = 255.0f;
  quality = select(quality, (vfloat)(40.0f), nearest_edge <= EDGE_RADIUS);
  quality = select(quality, (vfloat)(4.0f), nearest_edge <= EDGE_SPACING);
  quality = select(quality, min(quality, (vfloat)(16.0f)), AS_VINT(brightest) >= 252);
  quality = select((vfloat)(2.0f), quality, z > 0.0f);
  VSTORE(pixel | AS_VUINT(TO_VINT(quality)) << 24, image + index);
}
