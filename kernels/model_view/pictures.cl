// Pictures of a model view. A work-item paints one pixel.
//   picture  blue, green, red and 255 a pixel, without padding
//   depth, normals  of the view (raycast.cl)
#include "shared/color_map.h"
#include "shared/image.h"
#include "shared/normal.h"

#define BACKGROUND ((uchar4)(38, 32, 28, 255))
#define UNKNOWN_COLOR ((uchar4)(128, 128, 128, 255))
#define SURFACE ((float3)(225.0f, 212.0f, 200.0f))
#define AMBIENT 0.15f

inline float3 point_at(int x, int y, float z, const CameraArgs camera) {
  return z * (float3)((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1.0f);
}

// A grey surface lit from the camera.
__kernel void shade_view(__global uchar4* picture, __global const float* depth, __global const uint* normals,
                         CameraArgs camera) {
  const int x = get_global_id(0);
  const int y = get_global_id(1);
  if (x >= camera.width) return;
  const int index = pixel_index(x, y, camera);
  const float z = depth[index];
  const float3 normal = unpack_normal(normals[index]);
  const float towards_camera = fabs(dot(normal, normalize(point_at(x, y, 1.0f, camera))));
  const float3 shaded = SURFACE * (AMBIENT + (1.0f - AMBIENT) * towards_camera);
  picture[y * camera.width + x] = z > 0.0f ? convert_uchar4_sat_rte((float4)(shaded, 255.0f)) : BACKGROUND;
}

// The map's colours.
__kernel void color_view(__global uchar4* picture, __global const float* depth, __global const int* offsets,
                         __global const uint* colors, CameraArgs camera, TransformArgs T_W_D, GridArgs grid) {
  const int x = get_global_id(0);
  const int y = get_global_id(1);
  if (x >= camera.width) return;
  const float z = depth[pixel_index(x, y, camera)];
  uchar4 painted = BACKGROUND;
  if (z > 0.0f) {
    const float3 p_W = transform_point(T_W_D, point_at(x, y, z, camera));
    const float4 color = sample_color_nearby(p_W / grid.voxel_size_m, offsets, colors, grid);
    painted = color.w > 0.0f ? convert_uchar4_sat_rte((float4)(color.xyz, 255.0f)) : UNKNOWN_COLOR;
  }
  picture[y * camera.width + x] = painted;
}
