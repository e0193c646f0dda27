// Says how kernels over whole blocks share out the voxels, and gives the phase of a voxel's dither.
#include "shared/block_map.h"

#define ITEM_VOXELS VOXELS_PER_ITEM(SIMD_WIDTH, BLOCK_SIZE)
#define ITEMS_PER_BLOCK (BLOCK_VOXELS / ITEM_VOXELS)

#define DITHER_STEP 0x9e3779b9u

// Returns the phase of a voxel's dither. It is spread by a hash over the blocks, by the golden ratio along a
// block's voxels and by DITHER_STEP over the frames, so that the rounding errors of one voxel cancel over the
// frames faster than those of independent draws would.
inline uint dither_phase(int voxel, int3 block, int frame) {
  uint hash = (uint)(block.x * 73856093 ^ block.y * 19349669 ^ block.z * 83492791);
  hash = (hash ^ (hash >> 15)) * 0x85ebca6bu;
  return hash + (uint)(voxel + frame) * DITHER_STEP;
}
