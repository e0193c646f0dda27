// What the map says about the colour of the surface that the depth camera sees. A work-item samples one
// pixel.
//   points  p_W a sample
//   found   blue, green, red and weight a sample; weight 0 = no colour
#include "shared/color_map.h"
#include "shared/image.h"

__kernel void sample_surface(__global float4* points, __global float4* found, __global const float* depth,
                             __global const int* offsets, __global const uint* colors, CameraArgs camera,
                             TransformArgs T_W_D, GridArgs grid, int stride, int columns, int samples) {
  const int i = get_global_id(0);
  if (i >= samples) return;
  const int x = i % columns * stride + stride / 2;
  const int y = i / columns * stride + stride / 2;
  const float z = depth[pixel_index(x, y, camera)];
  points[i] = found[i] = 0.0f;
  if (!(z > 0.0f)) return;
  const float3 p_D = z * (float3)((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1.0f);
  const float3 p_W = transform_point(T_W_D, p_D);
  points[i] = (float4)(p_W, 0.0f);
  found[i] = sample_color(p_W / grid.voxel_size_m, offsets, colors, grid);
}
