// Copies the blocks of a batch, each with its border, out of the map. A work-item is one
// layer, of equal z, of one volume.
//   voxels, offsets  the map
//   blocks           count blocks
//   volume, row_masks  see batch.h; chi where there is no block or the certainty is below min_certainty
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

// Returns the highest bits of the bytes, side by side.
inline ulong high_bits(ulong bytes) {
  return ((bytes >> 7 & 0x0101010101010101UL) * 0x0102040810204080UL) >> 56;
}

inline char known_distance(__global const char* voxels, int slot, int voxel, int min_certainty) {
  if (slot < 0) return TSDF_CHI;
  const uchar certainty = as_uchar(voxels[block_certainties(slot) + voxel]);
  return certainty < min_certainty ? TSDF_CHI : voxels[block_distances(slot) + voxel];
}

inline ulong2 mask_of_voxel(char distance, int bit) {
  return (ulong2)((ulong)(distance != TSDF_CHI) << bit, (ulong)(distance < 0) << bit);
}

// Copies the block's own BLOCK_SIZE voxels; the masks' bit 0 is the first of them.
inline ulong2 gather_row(__global char* out, __global const char* voxels, int slot, int row,
                         int min_certainty) {
  ulong2 masks = 0;
  for (int x = 0; x < BLOCK_SIZE; x += PIECE) {
    const PieceUchars certainties = AS_UCHARS(LOAD_PIECE(0, voxels + block_certainties(slot) + row + x));
    PieceChars distances = LOAD_PIECE(0, voxels + block_distances(slot) + row + x);
    distances = select(distances, (PieceChars)(TSDF_CHI), certainties < (PieceUchars)(min_certainty));
    STORE_PIECE(distances, 0, out + x);
    const PieceChars known = distances != (PieceChars)(TSDF_CHI);
    masks |= (ulong2)(high_bits(PIECE_BITS(known)), high_bits(PIECE_BITS(distances))) << (ulong)x;
  }
  return masks;
}

inline ulong2 fill_row(__global char* out) {
  for (int x = 0; x < BLOCK_SIZE; ++x) out[x] = TSDF_CHI;
  return 0;
}

inline int slot_of(__global const int* offsets, int3 block, GridArgs grid) {
  const int address = block_address(block, grid);
  return address < 0 ? BLOCK_EMPTY : offsets[address];
}

// Gathers a row of the volume out of the block and those before and after it. `row` is its first voxel's
// number in the block.
inline ulong2 gather_padded_row(__global char* out, __global const char* voxels, int3 slots, int row,
                                int min_certainty) {
  const ulong2 own =
      slots.y < 0 ? fill_row(out + 1) : gather_row(out + 1, voxels, slots.y, row, min_certainty);
  out[0] = known_distance(voxels, slots.x, row + BLOCK_SIZE - 1, min_certainty);
  out[BLOCK_SIZE + 1] = known_distance(voxels, slots.z, row, min_certainty);
  out[BLOCK_SIZE + 2] = known_distance(voxels, slots.z, row + 1, min_certainty);
  return own << (ulong)1 | mask_of_voxel(out[0], 0) | mask_of_voxel(out[BLOCK_SIZE + 1], BLOCK_SIZE + 1) |
         mask_of_voxel(out[BLOCK_SIZE + 2], BLOCK_SIZE + 2);
}

__kernel void gather_blocks(__global char* volume, __global ulong2* row_masks, __global const char* voxels,
                            __global const int* offsets, __global const MeshBlockArgs* blocks, int count,
                            int min_certainty, GridArgs grid) {
  const int i = get_global_id(0);
  if (i >= count * PADDED_SIZE) return;
  const int z = i % PADDED_SIZE - 1;
  const int3 block = vload3(0, blocks[i / PADDED_SIZE].index) + (int3)(0, 0, z >> BLOCK_SIZE_LOG2);
  const int layer = (z & (BLOCK_SIZE - 1)) * BLOCK_SIZE * BLOCK_SIZE;
  int padded_row = i * PADDED_SIZE;
  for (int dy = -1; dy <= 1; ++dy) {
    const int3 slots = (int3)(slot_of(offsets, block + (int3)(-1, dy, 0), grid),
                              slot_of(offsets, block + (int3)(0, dy, 0), grid),
                              slot_of(offsets, block + (int3)(1, dy, 0), grid));
    const int first_y = dy < 0 ? BLOCK_SIZE - 1 : 0;
    const int last_y = dy > 0 ? 1 : BLOCK_SIZE - 1;
    for (int y = first_y; y <= last_y; ++y, ++padded_row) {
      row_masks[padded_row] = gather_padded_row(volume + padded_row * PADDED_SIZE, voxels, slots,
                                                layer + y * BLOCK_SIZE, min_certainty);
    }
  }
}
