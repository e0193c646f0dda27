// Finds which edges carry vertices, and how many vertices and triangles come of it. A work-item is one row of
// a block (classify_rows) or one block (scan_rows).
//   row_masks, rows  see batch.h
//   row_triangles    triangles of a row's cells; after scan_rows the number in its block of the first one
//   totals           vertices and triangles of a block
//   table            the triangles of the cube cases (surface_mesh/marching_cubes_table.h)
#include "surface_mesh/batch.h"

inline ulong with_next(ulong cells) { return cells | cells << 1; }

// An edge carries a vertex if its ends differ and one of the four cells around it is complete.
inline uint4 edges_with_vertices(__global const ulong2* row, ulong own_cells) {
  const ulong before_y = complete_cells(row - 1);
  const ulong before_z = complete_cells(row - PADDED_SIZE);
  const ulong before_yz = complete_cells(row - PADDED_SIZE - 1);
  const ulong inside = row[0].y;
  const ulong along_x = (inside ^ inside >> 1) & (own_cells | before_y | before_z | before_yz);
  const ulong along_y = (inside ^ row[1].y) & with_next(own_cells | before_z);
  const ulong along_z = (inside ^ row[PADDED_SIZE].y) & with_next(own_cells | before_y);
  const uint x = convert_uint(along_x >> 1 & OWN_VOXELS);
  const uint y = convert_uint(along_y >> 1 & OWN_VOXELS);
  const uint z = convert_uint(along_z >> 1 & OWN_VOXELS);
  return (uint4)(x, y, z, popcount(x) + popcount(y) + popcount(z));
}

inline uint count_triangles(ulong complete, ulong4 inside, __global const uchar* table) {
  uint triangles = 0;
  for (uint cells = cut_cells(complete, inside); cells != 0; cells &= cells - 1) {
    triangles += table[CUBE_CASE_BYTES * cube_case(inside, lowest_bit(cells))];
  }
  return triangles;
}

__kernel void classify_rows(__global uint4* rows, __global uint* row_triangles,
                            __global const ulong2* row_masks, __global const uchar* table, int count) {
  const int i = get_global_id(0);
  if (i >= count * ROWS) return;
  __global const ulong2* row = masks_of_row(row_masks, i / ROWS, i % BLOCK_SIZE, i % ROWS / BLOCK_SIZE);
  const ulong complete = complete_cells(row);
  rows[i] = edges_with_vertices(row, complete);
  row_triangles[i] = count_triangles(complete, inside_corners(row), table);
}

__kernel void scan_rows(__global uint4* rows, __global uint* row_triangles, __global uint2* totals,
                        int count) {
  const int block = get_global_id(0);
  if (block >= count) return;
  uint2 total = 0;
  for (int i = block * ROWS; i < (block + 1) * ROWS; ++i) {
    const uint2 of_row = (uint2)(rows[i].w, row_triangles[i]);
    rows[i].w = total.x;
    row_triangles[i] = total.y;
    total += of_row;
  }
  totals[block] = total;
}
