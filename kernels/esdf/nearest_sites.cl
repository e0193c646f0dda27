// The exact Euclidean distance transform of a region, an axis at a time (Saito and Toriwaki 1994): along z
// the nearest cell with a site, then along y the best of those, then along x. The distance is that to the
// site of the cell so found. Ties go to the cell that is nearer along the later axis, and of two to the
// first, so that a cell's distance does not depend on the region.
//   slots    of the blocks of cells of the region, -1 where there is none
//   along_z  a byte a cell: how far along z the site is; of the columns about the region, at its heights
//   planes   a word a cell: the square of the distance to the site in its plane of y and z, and the offset to
//            it along y and z, each + 128; of the rows about the region
#include "esdf/cells.h"

#define LEAVE_OFFSET 128

inline int width_of(const EsdfRegionArgs region) { return ESDF_BLOCK * region.blocks[0]; }
inline int block_in(int3 cell, const EsdfRegionArgs region) {
  return cell.x / ESDF_BLOCK +
         region.blocks[0] * (cell.y / ESDF_BLOCK + region.blocks[1] * (cell.z / ESDF_BLOCK));
}

// Tells which of SIMD_WIDTH cells of a row have a site.
inline vint have_site(int3 cell, __global const int* slots, __global const uint* sites,
                      const EsdfRegionArgs region) {
  const int slot = slots[block_in(cell, region)];
  if (slot < 0) return (vint)(0);
  return ALIGNED(const vuint, sites + (size_t)slot * ESDF_CELLS + cell_number(cell)) != (uint)ESDF_NO_SITE;
}

// Returns the offset to a site, or ESDF_NOWHERE.
inline vint within_reach(vint offset, const EsdfArgs args) {
  return select((vint)(ESDF_NOWHERE), offset, (offset >= -args.reach) & (offset <= args.reach));
}

// A work-item is a column of SIMD_WIDTH cells' width.
__kernel void nearest_along_z(__global const int* slots, __global const uint* sites, __global char* along_z,
                              EsdfRegionArgs region, EsdfArgs args) {
  const int width = width_of(region), depth = ESDF_BLOCK * region.blocks[1];
  const int x = get_global_id(0) * SIMD_WIDTH, y = get_global_id(1);
  if (x >= width || y >= depth) return;
  __global char* column = along_z + (size_t)y * width + x;
  const size_t level = (size_t)width * depth;
  const int end = region.first[2] + region.size[2];
  vint last = -2 * ESDF_NOWHERE;
  for (int z = 0; z < end; ++z) {
    last = select(last, (vint)(z), have_site((int3)(x, y, z), slots, sites, region));
    if (z < region.first[2]) continue;
    ALIGNED(vchar, column + (z - region.first[2]) * level) = TO_VCHAR(within_reach(last - z, args));
  }
  vint next = end + 4 * ESDF_NOWHERE;
  for (int z = ESDF_BLOCK * region.blocks[2] - 1; z >= region.first[2]; --z) {
    next = select(next, (vint)(z), have_site((int3)(x, y, z), slots, sites, region));
    if (z >= end) continue;
    __global char* place = column + (z - region.first[2]) * level;
    const vint before = TO_VINT(ALIGNED(const vchar, place)), after = within_reach(next - z, args);
    const vint size = select(before, -before, before < 0);
    ALIGNED(vchar, place) = TO_VCHAR(select(before, after, after < size));
  }
}

// A work-item is SIMD_WIDTH cells of a row.
__kernel void nearest_along_y(__global const char* along_z, __global uint* planes, EsdfRegionArgs region,
                              EsdfArgs args) {
  const int width = width_of(region), depth = ESDF_BLOCK * region.blocks[1];
  const int x = get_global_id(0) * SIMD_WIDTH;
  const int y = get_global_id(1) % region.size[1], z = get_global_id(1) / region.size[1];
  if (x >= width || z >= region.size[2]) return;
  __global const char* row = along_z + ((size_t)z * depth + region.first[1] + y) * width + x;
  const int far = (args.reach + 1) * (args.reach + 1);
  vint best = far, best_y = 0, best_z = ESDF_NOWHERE;
  for (int j = 0; j <= args.reach && ANY(best > j * j); ++j) {
    for (int sign = -1; sign <= (j == 0 ? -1 : 1); sign += 2) {
      const vint up = TO_VINT(ALIGNED(const vchar, row + sign * j * width));
      const vint squared = up * up + j * j;
      const vint better = squared < best;
      best = select(best, squared, better);
      best_y = select(best_y, (vint)(sign * j), better);
      best_z = select(best_z, up, better);
    }
  }
  ALIGNED(vuint, planes + ((size_t)z * region.size[1] + y) * width + x) =
      AS_VUINT(best << 16 | (best_y + LEAVE_OFFSET) << 8 | (best_z + LEAVE_OFFSET));
}

// Computes how far from the middles of the cells the sites are that lie (dx, dy, dz) cells away.
inline vfloat site_distance_m(int3 cell, vint found, vint dx, vint dy, vint dz, __global const int* slots,
                              __global const uint* sites, const EsdfRegionArgs region, const EsdfArgs args) {
  const vint x = select((vint)(0), cell.x + LANE_INDICES + dx, found);
  const vint y = select((vint)(0), cell.y + dy, found);
  const vint z = select((vint)(0), cell.z + dz, found);
  const vint block =
      x / ESDF_BLOCK + region.blocks[0] * (y / ESDF_BLOCK + region.blocks[1] * (z / ESDF_BLOCK));
  const vint slot = max(GATHER(vint, slots, block), (vint)(0));
  const vint number =
      (x & (ESDF_BLOCK - 1)) + ESDF_BLOCK * ((y & (ESDF_BLOCK - 1)) + ESDF_BLOCK * (z & (ESDF_BLOCK - 1)));
  const vint site = AS_VINT(GATHER(vuint, sites, slot * ESDF_CELLS + number));
  const float k = (float)args.cell_voxels;
  const vfloat off_x = TO_VFLOAT(dx) * k + TO_VFLOAT(site & 31) - 0.5f * k;
  const vfloat off_y = TO_VFLOAT(dy) * k + TO_VFLOAT(site >> 5 & 31) - 0.5f * k;
  const vfloat off_z = TO_VFLOAT(dz) * k + TO_VFLOAT(site >> 10 & 31) - 0.5f * k;
  return args.voxel_m * sqrt(off_x * off_x + off_y * off_y + off_z * off_z);
}

// A work-item is SIMD_WIDTH cells of a row of a block that is computed.
//   blocks   first cell, and slot, of the blocks that are computed
//   results  a word a cell of the list: the distance in steps, below a byte of state: -1 unknown, 0 free, 1
//            occupied
__kernel void nearest_along_x(__global const int* slots, __global const uint* sites,
                              __global const char* middles, __global const uchar* seen,
                              __global const uint* planes, __global const int4* blocks, int count,
                              __global int* results, EsdfRegionArgs region, EsdfArgs args) {
  const int items = ESDF_CELLS / SIMD_WIDTH;
  const int i = get_global_id(0) / items, number = get_global_id(0) % items * SIMD_WIDTH;
  if (i >= count) return;
  const int4 block = blocks[i];
  const int3 cell = block.xyz + (int3)(number % ESDF_BLOCK, number / ESDF_BLOCK % ESDF_BLOCK,
                                       number / (ESDF_BLOCK * ESDF_BLOCK));
  const size_t in_pool = (size_t)block.w * ESDF_CELLS + number;
  const vint middle = TO_VINT(ALIGNED(const vchar, middles + in_pool));
  const vint seen_free = TO_VINT(ALIGNED(const vuchar, seen + in_pool)) >= ESDF_FREE;
  // At the edges of things the map has distances behind a surface in front of it; rays that went on through
  // there know better.
  const vint near = (middle != TSDF_CHI) & NOT((middle < 0) & seen_free);
  const vint is_free = seen_free & NOT(near);
  const vint has_site = ALIGNED(const vuint, sites + in_pool) != (uint)ESDF_NO_SITE;
  __global const uint* row =
      planes +
      ((size_t)(cell.z - region.first[2]) * region.size[1] + (cell.y - region.first[1])) * width_of(region) +
      cell.x;
  const int far = (args.reach + 1) * (args.reach + 1);
  vint best = select((vint)(0), (vint)(far), is_free), best_x = 0, best_plane = 0;
  for (int j = 0; j <= args.reach && ANY(best > j * j); ++j) {
    for (int sign = -1; sign <= (j == 0 ? -1 : 1); sign += 2) {
      const vint plane = AS_VINT(VLOAD(row + sign * j));
      const vint squared = (plane >> 16) + j * j;
      const vint better = squared < best;
      best = select(best, squared, better);
      best_x = select(best_x, (vint)(sign * j), better);
      best_plane = select(best_plane, plane, better);
    }
  }
  const vint found = is_free & (best < far);
  const vfloat from_site_m =
      min(site_distance_m(cell, found, best_x, (best_plane >> 8 & 255) - LEAVE_OFFSET,
                          (best_plane & 255) - LEAVE_OFFSET, slots, sites, region, args),
          args.max_distance_m);
  const vfloat free_m = select((vfloat)(args.max_distance_m), from_site_m, found);
  const vfloat distance_m = select(free_m, TO_VFLOAT(middle) * (args.truncation_m / TSDF_MAX), near);
  const vint steps = TO_VINT(distance_m * args.steps_per_m);
  const vint known = near | is_free;
  const vint occupied = has_site | (near & (middle < 0));
  const vint state = select(select((vint)(-1), (vint)(0), known), (vint)(1), occupied);
  ALIGNED(vint, results + (size_t)i * ESDF_CELLS + number) =
      (select((vint)(ESDF_UNKNOWN), steps, known) & 0xffff) | (state & 255) << 16;
}
