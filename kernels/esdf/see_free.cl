// Counts which cells a depth image sees to be free, and which are hidden close behind what it sees. A
// work-item is SIMD_WIDTH cells of a row.
//   blocks   index and slot of the blocks of cells in view
//   seen     a count a cell of the pool
//   changes  ESDF_* bits a block in view
//   sight    what it counts for to be seen, doubt: what it takes to be hidden
#include "esdf/cells.h"
#include "shared/image.h"

__kernel void see_free(__global const float* depth, __global const int4* blocks, int count,
                       __global uchar* seen, __global int* changes, int sight, int doubt, CameraArgs camera,
                       TransformArgs T_D_W, SensorArgs sensor, EsdfArgs args) {
  const int items = ESDF_CELLS / SIMD_WIDTH;
  const int i = get_global_id(0) / items, number = get_global_id(0) % items * SIMD_WIDTH;
  if (i >= count) return;
  const int4 block = blocks[i];
  const vint column = number % ESDF_BLOCK + LANE_INDICES;
  const vfloat x = (TO_VFLOAT(ESDF_BLOCK * block.x + column) + 0.5f) * args.cell_m;
  const float y = (ESDF_BLOCK * block.y + number / ESDF_BLOCK % ESDF_BLOCK + 0.5f) * args.cell_m;
  const float z = (ESDF_BLOCK * block.z + number / (ESDF_BLOCK * ESDF_BLOCK) + 0.5f) * args.cell_m;
  const vfloat in_front = rotated(T_D_W, 2, x, y, z) + T_D_W.translation[2];
  const vfloat u =
      camera.fx * (rotated(T_D_W, 0, x, y, z) + T_D_W.translation[0]) / in_front + (camera.cx + 0.5f);
  const vfloat v =
      camera.fy * (rotated(T_D_W, 1, x, y, z) + T_D_W.translation[1]) / in_front + (camera.cy + 0.5f);
  const vint in_view =
      (in_front > 0.0f) & (u >= 0.0f) & (u < camera.width) & (v >= 0.0f) & (v < camera.height);
  if (!ANY(in_view)) return;
  const vint pixel = select((vint)(0), pixel_indices(TO_VINT(u), TO_VINT(v), camera), in_view);
  const vfloat measured = GATHER(vfloat, depth, pixel);
  const vfloat ahead_m = measured - in_front;
  const vfloat margin_m = args.truncation_m + AXIAL_SIGMA_M(sensor, measured);
  const vint is_free = (measured > 0.0f) & (ahead_m > margin_m);
  const vint is_hidden = (measured > 0.0f) & (ahead_m < -args.truncation_m) & (ahead_m > -args.hidden_m);
  if (!ANY(is_free | is_hidden)) return;
  __global uchar* counts = seen + (size_t)block.w * ESDF_CELLS + number;
  const vint old = TO_VINT(ALIGNED(const vuchar, counts));
  const vint counted = select(select(old, old - doubt, is_hidden), old + sight, is_free);
  const vint now = clamp(counted, (vint)(0), (vint)(ESDF_FREE_MAX));
  ALIGNED(vuchar, counts) = TO_VUCHAR(now);
  if (ANY(((old >= ESDF_FREE) | (now >= ESDF_FREE)) & NOT((old >= ESDF_FREE) & (now >= ESDF_FREE))))
    atomic_or(changes + i, ESDF_KNOWN_CHANGED);
}
