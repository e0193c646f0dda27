// Layout of a batch of blocks, gathered with a border so that a block needs no other one.
//   volume     (BLOCK_SIZE + 3)^3 distance bytes a block: voxels -1 to BLOCK_SIZE + 1 in each axis
//   row_masks  known and inside (negative) voxels of a row of the volume: bit x + 1 is voxel x
//   rows       a row of the block proper, bit x is voxel x: the voxels whose edge in x, in y and in z carries
//              a vertex, and the number in its block of the row's first vertex. A row's vertices are those of
//              its edges in x, then in y, then in z.
#include "shared/block_map.h"

#define ROWS (BLOCK_SIZE * BLOCK_SIZE)
#define PADDED_SIZE (BLOCK_SIZE + 3)
#define PADDED_ROWS (PADDED_SIZE * PADDED_SIZE)
#define OWN_VOXELS (((ulong)1 << BLOCK_SIZE) - 1)
#define CUBE_CASE_BYTES 16

inline int lowest_bit(uint mask) { return 31 - clz(mask & -mask); }

// Returns the number in its row of a row's first vertex on edges along the axis.
inline uint first_on_axis(uint4 row, int axis) {
  return (axis > 0 ? popcount(row.x) : 0) + (axis > 1 ? popcount(row.y) : 0);
}

// Returns the masks of the row (y, z) of a block.
inline __global const ulong2* masks_of_row(__global const ulong2* row_masks, int block, int y, int z) {
  return row_masks + block * PADDED_ROWS + (y + 1) + PADDED_SIZE * (z + 1);
}

// Returns the cells between the row and its neighbours at y + 1 and z + 1 whose eight corners are known: bit
// x + 1 is cell x.
inline ulong complete_cells(__global const ulong2* row) {
  const ulong known = row[0].x & row[1].x & row[PADDED_SIZE].x & row[PADDED_SIZE + 1].x;
  return known & known >> 1;
}

// Holds the inside voxels of the four rows around a row of cells.
inline ulong4 inside_corners(__global const ulong2* row) {
  return (ulong4)(row[0].y, row[1].y, row[PADDED_SIZE].y, row[PADDED_SIZE + 1].y);
}

// Returns the block's own cells that the surface cuts: bit x is cell x.
inline uint cut_cells(ulong complete, ulong4 inside) {
  const ulong some = inside.x | inside.y | inside.z | inside.w;
  const ulong all_four = inside.x & inside.y & inside.z & inside.w;
  const ulong cut = complete & (some | some >> 1) & ~(all_four & all_four >> 1);
  return convert_uint(cut >> 1 & OWN_VOXELS);
}

// Sets bit c if corner c of cell x, at (c & 1, c >> 1 & 1, c >> 2 & 1), is inside.
inline uint cube_case(ulong4 inside, int x) {
  const uint4 pairs = convert_uint4(inside >> (ulong)(x + 1)) & 3;
  return pairs.x | pairs.y << 2 | pairs.z << 4 | pairs.w << 6;
}
