// Copies the blocks of a batch, each with its border, out of the map. A work-item is one row of one volume.
//   voxels, offsets  the map
//   blocks           count blocks
//   volume, row_masks  see batch.h; chi where there is no block or the weight is below min_weight
#include "surface_mesh/batch.h"

#if BLOCK_SIZE == 4
#define PIECE 4
#define LOAD_PIECE vload4
#define STORE_PIECE vstore4
#define PIECE_BITS(x) ((ulong)as_uint(x))
#define AS_UCHARS as_uchar4
typedef char4 PieceChars;
typedef uchar4 PieceUchars;
#else
#define PIECE 8
#define LOAD_PIECE vload8
#define STORE_PIECE vstore8
#define PIECE_BITS(x) as_ulong(x)
#define AS_UCHARS as_uchar8
typedef char8 PieceChars;
typedef uchar8 PieceUchars;
#endif

// The highest bit of each byte, side by side.
inline ulong high_bits(ulong bytes) {
  return ((bytes >> 7 & 0x0101010101010101UL) * 0x0102040810204080UL) >> 56;
}

inline char known_distance(__global const char *voxels, int slot, int voxel, int min_weight) {
  if (slot < 0) return TSDF_CHI;
  const uchar weight = as_uchar(voxels[block_weights(slot) + voxel]);
  return weight < min_weight ? TSDF_CHI : voxels[block_distances(slot) + voxel];
}

inline ulong2 mask_of_voxel(char distance, int bit) {
  return (ulong2)((ulong)(distance != TSDF_CHI) << bit, (ulong)(distance < 0) << bit);
}

// Copies the block's own BLOCK_SIZE voxels; the masks' bit 0 is the first of them.
inline ulong2 gather_row(__global char *out, __global const char *voxels, int slot, int row, int min_weight) {
  ulong2 masks = 0;
  for (int x = 0; x < BLOCK_SIZE; x += PIECE) {
    const PieceUchars weights =
        AS_UCHARS(LOAD_PIECE(0, voxels + block_weights(slot) + row + x));
    PieceChars distances = LOAD_PIECE(0, voxels + block_distances(slot) + row + x);
    distances = select(distances, (PieceChars)(TSDF_CHI), weights < (PieceUchars)(min_weight));
    STORE_PIECE(distances, 0, out + x);
    const PieceChars known = distances != (PieceChars)(TSDF_CHI);
    masks |= (ulong2)(high_bits(PIECE_BITS(known)), high_bits(PIECE_BITS(distances))) << (ulong)x;
  }
  return masks;
}

inline ulong2 fill_row(__global char *out) {
  for (int x = 0; x < BLOCK_SIZE; ++x) out[x] = TSDF_CHI;
  return 0;
}

inline int slot_of(__global const int *offsets, int3 block, GridArgs grid) {
  const int address = block_address(block, grid);
  return address < 0 ? BLOCK_EMPTY : offsets[address];
}

__kernel void gather_blocks(__global char *volume, __global ulong2 *row_masks, __global const char *voxels,
                            __global const int *offsets, __global const MeshBlockArgs *blocks, int count,
                            int min_weight, GridArgs grid) {
  const int i = get_global_id(0);
  if (i >= count * PADDED_ROWS) return;
  const int y = i % PADDED_ROWS % PADDED_SIZE - 1;
  const int z = i % PADDED_ROWS / PADDED_SIZE - 1;
  __global const int *index = blocks[i / PADDED_ROWS].index;
  const int3 block = (int3)(index[0], index[1] + (y >> BLOCK_SIZE_LOG2), index[2] + (z >> BLOCK_SIZE_LOG2));
  const int row = ((y & (BLOCK_SIZE - 1)) + BLOCK_SIZE * (z & (BLOCK_SIZE - 1))) * BLOCK_SIZE;
  __global char *out = volume + i * PADDED_SIZE;

  const int before = slot_of(offsets, block - (int3)(1, 0, 0), grid);
  const int middle = slot_of(offsets, block, grid);
  const int after = slot_of(offsets, block + (int3)(1, 0, 0), grid);
  const ulong2 own = middle < 0 ? fill_row(out + 1) : gather_row(out + 1, voxels, middle, row, min_weight);
  out[0] = known_distance(voxels, before, row + BLOCK_SIZE - 1, min_weight);
  out[BLOCK_SIZE + 1] = known_distance(voxels, after, row, min_weight);
  out[BLOCK_SIZE + 2] = known_distance(voxels, after, row + 1, min_weight);
  row_masks[i] = own << (ulong)1 | mask_of_voxel(out[0], 0) | mask_of_voxel(out[BLOCK_SIZE + 1], BLOCK_SIZE + 1) |
                 mask_of_voxel(out[BLOCK_SIZE + 2], BLOCK_SIZE + 2);
}
