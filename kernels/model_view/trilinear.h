// Trilinear interpolation of the distance. Coordinates are voxels from the first voxel of the window.
#include "shared/window.h"

// Holds, for the two voxels around a coordinate along one axis, their places in their blocks, and their
// blocks' places in the window.
typedef struct {
  vint in_block[2], block[2];
  vint crosses;  // whether the second voxel lies in another block
  vint inside;   // whether both blocks are in the window
} AxisNeighbours;

inline AxisNeighbours axis_neighbours(vint voxel, int axis, const GridArgs grid) {
  const vint block = voxel >> BLOCK_SIZE_LOG2, next_block = (voxel + 1) >> BLOCK_SIZE_LOG2;
  const int n = grid.blocks_per_axis;
  AxisNeighbours result;
  result.in_block[0] = voxel & (BLOCK_SIZE - 1);
  result.in_block[1] = (voxel + 1) & (BLOCK_SIZE - 1);
  result.block[0] = wrap(block, grid.wrapped_origin[axis], n);
  result.block[1] = wrap(next_block, grid.wrapped_origin[axis], n);
  result.crosses = block != next_block;
  result.inside = in_window(block, n) & in_window(next_block, n);
  return result;
}

// Finds the slots of the blocks of a cell's corners. A corner's number says along which axes it is the second
// voxel (bit 0: x, 1: y, 2: z); its slot is looked up only where the cell crosses into another block along
// all of these.
inline void find_slots(const AxisNeighbours axes[3], vint inside, __global const int* offsets,
                       int blocks_per_axis, vint slots[8]) {
#pragma unroll
  for (int corner = 0; corner < 8; ++corner) {
    vint slot = -1, own = inside;
#pragma unroll
    for (int i = 0; i < 3; ++i) {
      if (!(corner >> i & 1)) continue;
      slot = select(slots[corner ^ 1 << i], slot, axes[i].crosses);
      own &= axes[i].crosses;
    }
    if (ANY(own)) {
      const vint address =
          axes[0].block[corner & 1] +
          blocks_per_axis * (axes[1].block[corner >> 1 & 1] + blocks_per_axis * axes[2].block[corner >> 2]);
      slot = select(slot, slot_at(address, own, offsets), own);
    }
    slots[corner] = slot;
  }
}

// Holds the distance interpolated at p, in steps of the distance byte, and its gradient in steps a voxel;
// `known` is 0 where one of the eight voxels is chi.
typedef struct {
  vfloat value, gradient_x, gradient_y, gradient_z;
  vint known;
} Sample;

inline Sample interpolate(vfloat px, vfloat py, vfloat pz, vint active, __global const int* offsets,
                          __global const char* voxels, const GridArgs grid) {
  const vint vx = TO_VINT(px), vy = TO_VINT(py), vz = TO_VINT(pz);
  const AxisNeighbours axes[3] = {axis_neighbours(vx, 0, grid), axis_neighbours(vy, 1, grid),
                                  axis_neighbours(vz, 2, grid)};
  const vint inside = active & axes[0].inside & axes[1].inside & axes[2].inside;
  const bool any_crosses_x = ANY(inside & axes[0].crosses);
  vint slots[8];
  find_slots(axes, inside, offsets, grid.blocks_per_axis, slots);
  Sample sample;
  sample.known = inside;
  vfloat corner[8];
#pragma unroll
  for (int i = 0; i < 8; i += 2) {
    const vint row_in_block = (axes[1].in_block[i >> 1 & 1] << BLOCK_SIZE_LOG2) +
                              (axes[2].in_block[i >> 2] << (2 * BLOCK_SIZE_LOG2));
    const vint four = GATHER_FOUR_BYTES(voxels, distances_of(slots[i]) + row_in_block + axes[0].in_block[0]);
    const vint first = four << 24 >> 24;
    vint second = four << 16 >> 24;
    if (any_crosses_x) {
      second =
          select(second, GATHER_BYTES(voxels, distances_of(slots[i + 1]) + row_in_block), axes[0].crosses);
    }
    sample.known &= (slots[i] >= 0) & (slots[i + 1] >= 0) & (first != TSDF_CHI) & (second != TSDF_CHI);
    corner[i] = TO_VFLOAT(first);
    corner[i + 1] = TO_VFLOAT(second);
  }
  const vfloat x = px - TO_VFLOAT(vx), y = py - TO_VFLOAT(vy), z = pz - TO_VFLOAT(vz);
  const vfloat x00 = corner[1] - corner[0], x10 = corner[3] - corner[2];
  const vfloat x01 = corner[5] - corner[4], x11 = corner[7] - corner[6];
  const vfloat v00 = corner[0] + x * x00, v10 = corner[2] + x * x10;
  const vfloat v01 = corner[4] + x * x01, v11 = corner[6] + x * x11;
  const vfloat v0 = v00 + y * (v10 - v00), v1 = v01 + y * (v11 - v01);
  const vfloat gx0 = x00 + y * (x10 - x00), gx1 = x01 + y * (x11 - x01);
  sample.value = v0 + z * (v1 - v0);
  sample.gradient_x = gx0 + z * (gx1 - gx0);
  sample.gradient_y = (v10 - v00) + z * ((v11 - v01) - (v10 - v00));
  sample.gradient_z = v1 - v0;
  return sample;
}
