// Triangles of the core blocks of a batch. A work-item is one row of a block.
//   row_masks, rows  see batch.h
//   row_triangles    number of a row's first triangle in its block
//   table            the triangles of the cube cases (surface_mesh/marching_cubes_table.h)
//   triangles        three vertices of the mesh, counter-clockwise seen from free space
#include "surface_mesh/batch.h"

// Returns the number in the mesh of the vertex on an edge that starts at a voxel of the block or of the
// blocks beyond it.
inline uint vertex_number(__global const MeshBlockArgs* blocks, __global const uint4* rows, int block,
                          int3 voxel, int axis) {
  const int3 beyond = voxel >> BLOCK_SIZE_LOG2;
  const int owner = blocks[block].neighbours[beyond.x | beyond.y << 1 | beyond.z << 2];
  const int3 inside = voxel & (BLOCK_SIZE - 1);
  const uint4 row = rows[owner * ROWS + inside.y + BLOCK_SIZE * inside.z];
  const uint edges = axis == 0 ? row.x : axis == 1 ? row.y : row.z;
  const uint before = popcount(edges & ((1u << inside.x) - 1));
  return blocks[owner].first_vertex + row.w + first_on_axis(row, axis) + before;
}

__kernel void emit_triangles(__global uint* triangles, __global const ulong2* row_masks,
                             __global const uint4* rows, __global const uint* row_triangles,
                             __global const uchar* table, __global const MeshBlockArgs* blocks,
                             int core_count) {
  const int i = get_global_id(0);
  if (i >= core_count * ROWS) return;
  const int block = i / ROWS;
  if (blocks[block].neighbours[0] < 0) return;
  const int y = i % BLOCK_SIZE;
  const int z = i % ROWS / BLOCK_SIZE;
  __global const ulong2* row = masks_of_row(row_masks, block, y, z);
  const ulong4 inside = inside_corners(row);
  __global uint* out = triangles + 3 * (size_t)(blocks[block].first_triangle + row_triangles[i]);
  for (uint cells = cut_cells(complete_cells(row), inside); cells != 0; cells &= cells - 1) {
    const int x = lowest_bit(cells);
    __global const uchar* entry = table + CUBE_CASE_BYTES * cube_case(inside, x);
    const int corners = 3 * entry[0];
    for (int corner = 0; corner < corners; ++corner) {
      const int edge = entry[1 + corner];
      const int3 voxel = (int3)(x, y, z) + ((int3)(edge >> 2, edge >> 3, edge >> 4) & 1);
      *out++ = vertex_number(blocks, rows, block, voxel, edge & 3);
    }
  }
}
