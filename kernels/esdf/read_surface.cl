// Reads, from the blocks of the map that lie in a block of cells, where the surface is: each cell's site, and
// the distance byte of the voxel in its middle.
//   voxels  distances and certainties of the map's pool
//   slots   the map's blocks to read; places: of the block of cells that each of them lies in, in the lists
//   sites, middles  lists of blocks of cells; before: ESDF_NO_SITE and TSDF_CHI
#include "esdf/cells.h"

inline void offer_site(int3 voxel, __global uint* sites, const EsdfArgs args) {
  const int k = args.cell_voxels;
  const int3 cell =
      (int3)(floor_division(voxel.x, k), floor_division(voxel.y, k), floor_division(voxel.z, k));
  const int3 in_cell = voxel - k * cell;
  const int3 off = in_cell - k / 2;
  const uint site = (uint)(off.x * off.x + off.y * off.y + off.z * off.z) << ESDF_SITE_BITS |
                    in_cell.z << 10 | in_cell.y << 5 | in_cell.x;
  __global uint* place = sites + cell_number(cell);
  if (site < *place) atomic_min(place, site);
}

// Returns the first place of a block, from `first` on, that is in the middle of a cell.
inline int first_middle(int first, int k) {
  const int ahead = k / 2 - first;
  return ahead - k * floor_division(ahead, k);
}

// A work-item is a block of the map.
__kernel void read_surface(__global const char* voxels, __global const int4* block_indices,
                           __global const int* slots, __global const int* places, int count,
                           __global uint* sites, __global char* middles, EsdfArgs args) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const int slot = slots[i], k = args.cell_voxels;
  const int3 first = block_indices[slot].xyz * BLOCK_SIZE;
  __global const char* distances = voxels + block_distances(slot);
  sites += (size_t)places[i] * ESDF_CELLS;
  middles += (size_t)places[i] * ESDF_CELLS;
  for (int v = 0; v < BLOCK_VOXELS; v += SIMD_WIDTH) {
    const vint steps = TO_VINT(ALIGNED(const vchar, distances + v));
    if (!ANY((steps <= args.surface_steps) & (steps >= -args.surface_steps))) continue;
    for (int lane = v; lane < v + SIMD_WIDTH; ++lane) {
      if (distances[lane] > args.surface_steps || distances[lane] < -args.surface_steps) continue;
      const int3 in_block = (int3)(lane & (BLOCK_SIZE - 1), lane >> BLOCK_SIZE_LOG2 & (BLOCK_SIZE - 1),
                                   lane >> (2 * BLOCK_SIZE_LOG2));
      offer_site(first + in_block, sites, args);
    }
  }
  for (int z = first_middle(first.z, k); z < BLOCK_SIZE; z += k) {
    for (int y = first_middle(first.y, k); y < BLOCK_SIZE; y += k) {
      for (int x = first_middle(first.x, k); x < BLOCK_SIZE; x += k) {
        const int3 cell = (int3)(floor_division(first.x + x, k), floor_division(first.y + y, k),
                                 floor_division(first.z + z, k));
        middles[cell_number(cell)] = distances[voxel_number((int3)(x, y, z))];
      }
    }
  }
}

// Takes what was read over into the pool, and notes what is new of it. A work-item is a row of cells.
//   slots    of the blocks of cells in the list
//   changes  ESDF_* bits an entry of the list
__kernel void adopt_surface(__global const uint* new_sites, __global const char* new_middles,
                            __global const int* slots, int count, __global uint* sites,
                            __global char* middles, __global int* changes) {
  const int rows = ESDF_BLOCK * ESDF_BLOCK;
  const int i = get_global_id(0) / rows, row = get_global_id(0) % rows;
  if (i >= count) return;
  const size_t from = (size_t)i * ESDF_CELLS + row * ESDF_BLOCK;
  const size_t to = (size_t)slots[i] * ESDF_CELLS + row * ESDF_BLOCK;
  int bits = 0;
  for (int x = 0; x < ESDF_BLOCK; ++x) {
    if (sites[to + x] != new_sites[from + x]) bits |= ESDF_SITES_CHANGED;
    if (middles[to + x] != new_middles[from + x]) bits |= ESDF_KNOWN_CHANGED;
    sites[to + x] = new_sites[from + x];
    middles[to + x] = new_middles[from + x];
  }
  if (bits) atomic_or(changes + i, bits);
}
