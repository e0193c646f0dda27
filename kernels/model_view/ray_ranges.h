// Where the rays of a tile of the view can hit (the paper's start and end textures): the depth of the nearest surface,
// and a bit for every bin of depth with some.
//   nearest   metres; float bits as ints, whose order is the same for positive floats
//   occupied  two words a tile, the lower bins' first
#include "shared/types.h"

typedef struct {
  float nearest_m;
  ulong bins;
} TileRange;

inline int depth_bin(float depth_m, const RayRangeArgs range) {
  return clamp((int)((depth_m - range.min_m) * range.bins_per_m), 0, DEPTH_BINS - 1);
}

inline int tiles_across(int pixels) { return (pixels + RANGE_TILE - 1) / RANGE_TILE; }

// Of the tile that the pixel lies in.
inline TileRange tile_range(int x, int y, __global const float *nearest, __global const uint *occupied,
                            const CameraArgs camera) {
  const int tile = y / RANGE_TILE * tiles_across(camera.width) + min(x, camera.width - 1) / RANGE_TILE;
  const TileRange range = {nearest[tile], upsample(occupied[2 * tile + 1], occupied[2 * tile])};
  return range;
}

// Depth from which on there may be a surface again, at or after depth_m; MAXFLOAT if there is none.
inline float next_occupied(ulong occupied, float depth_m, const RayRangeArgs range) {
  const int bin = depth_bin(depth_m, range);
  const ulong rest = occupied >> bin;
  if (rest == 0) return MAXFLOAT;
  if (rest & 1) return depth_m;
  const int skipped = DEPTH_BINS - 1 - (int)clz(rest & -rest);
  return range.min_m + (bin + skipped) / range.bins_per_m;
}
