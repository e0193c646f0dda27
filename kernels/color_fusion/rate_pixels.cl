// The quality of the colour camera's pixels. Images as in shared/types.h.
//   depth_C  of the colour camera, metres, 0 = none
#include "shared/image.h"

// Sets the highest byte of each pixel of the image to how far its colour can be trusted: little beside a
// depth edge, where depth and colour disagree about which side a pixel is on, where there is no depth, and
// where the sensor is overexposed. A work-item takes SIMD_WIDTH pixels of a row.
#define EDGE_RADIUS 4
#define EDGE_SPACING 2
__kernel void rate_pixels(__global uint* image, __global const float* depth_C, CameraArgs camera,
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
