// Colours of the vertices of a batch. A work-item is one vertex.
//   vertices         position and normal, six floats
//   vertex_colors    red, green, blue and 255 a vertex; UNKNOWN_COLOR where the map has none
//   offsets, colors  of the map
#include "shared/color_map.h"

#define UNKNOWN_COLOR ((uchar4)(128, 128, 128, 255))

__kernel void color_vertices(__global uchar4* vertex_colors, __global const float* vertices,
                             __global const int* offsets, __global const uint* colors, int count,
                             GridArgs grid) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const float4 color =
      sample_color_nearby(vload3(2 * i, vertices) / grid.voxel_size_m, offsets, colors, grid);
  const uchar4 rounded = convert_uchar4_sat_rte((float4)(color.zyx, 255.0f));
  vertex_colors[i] = color.w > 0.0f ? rounded : UNKNOWN_COLOR;
}
