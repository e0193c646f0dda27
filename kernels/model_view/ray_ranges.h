// Where the rays of a tile of the view can hit (the paper's start and end textures): the depth of the nearest
// surface, and a bit for every bin of depth with some.
//   nearest   metres; float bits as ints, whose order is the same for positive floats
//   occupied  two words a tile, the lower bins' first
#include "shared/simd.h"
#include "shared/types.h"

inline int depth_bin(float depth_m, const RayRangeArgs range) {
  return clamp((int)((depth_m - range.min_m) * range.bins_per_m), 0, DEPTH_BINS - 1);
}

inline int tiles_across(int pixels) { return (pixels + RANGE_TILE - 1) / RANGE_TILE; }

// Returns the tile that each pixel lies in; pixels beside the image count as pixels of its border.
inline vint tiles_of(vint x, vint y, const CameraArgs camera) {
  return min(y, (vint)(camera.height - 1)) / RANGE_TILE * tiles_across(camera.width) +
         min(x, (vint)(camera.width - 1)) / RANGE_TILE;
}

inline ulong bins_of(int tile, __global const uint* occupied) {
  return upsample(occupied[2 * tile + 1], occupied[2 * tile]);
}

// Returns the depth, at or after depth_m, from which on there may be a surface again; MAXFLOAT if there is
// none.
inline float next_occupied(ulong occupied, float depth_m, const RayRangeArgs range) {
  const int bin = depth_bin(depth_m, range);
  const ulong rest = occupied >> bin;
  if (rest == 0) return MAXFLOAT;
  if (rest & 1) return depth_m;
  const int skipped = DEPTH_BINS - 1 - (int)clz(rest & -rest);
  return range.min_m + (bin + skipped) / range.bins_per_m;
}
