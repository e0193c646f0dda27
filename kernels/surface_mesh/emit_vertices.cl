// Vertices of the core blocks of a batch. A work-item is one row of a block.
//   volume, rows  see batch.h
//   vertices      position and normal, six floats; the first is vertex first_of_batch of the mesh
#include "surface_mesh/batch.h"

// An exact zero counts as a little outside, so that the vertices of several edges never coincide.
#define ZERO_DISTANCE (1.0f / 16.0f)

inline float distance_at(__global const char* voxel) {
  return *voxel == 0 ? ZERO_DISTANCE : convert_float(*voxel);
}

// Returns the central difference, or a one-sided one where one neighbour is unknown.
inline float slope(__global const char* voxel, int stride) {
  const bool has_lower = voxel[-stride] != TSDF_CHI;
  const bool has_upper = voxel[stride] != TSDF_CHI;
  const float lower = convert_float(has_lower ? voxel[-stride] : voxel[0]);
  const float upper = convert_float(has_upper ? voxel[stride] : voxel[0]);
  return has_lower && has_upper ? 0.5f * (upper - lower) : upper - lower;
}

inline float3 gradient(__global const char* voxel) {
  return (float3)(slope(voxel, 1), slope(voxel, PADDED_SIZE), slope(voxel, PADDED_SIZE * PADDED_SIZE));
}

inline void emit_vertex(__global float* vertex, __global const char* voxel, int stride, float3 axis,
                        float3 corner_vox, float voxel_size_m) {
  const float lower = distance_at(voxel);
  const float upper = distance_at(voxel + stride);
  const float fraction = lower / (lower - upper);
  const float3 slope_there = mix(gradient(voxel), gradient(voxel + stride), fraction);
  const float3 outward = dot(slope_there, slope_there) > 0.0f ? slope_there : axis * (upper - lower);
  vstore3(voxel_size_m * (corner_vox + fraction * axis), 0, vertex);
  vstore3(normalize(outward), 1, vertex);
}

__kernel void emit_vertices(__global float* vertices, __global const char* volume, __global const uint4* rows,
                            __global const MeshBlockArgs* blocks, int core_count, uint first_of_batch,
                            float voxel_size_m) {
  const int i = get_global_id(0);
  if (i >= core_count * ROWS) return;
  const int block = i / ROWS;
  const int y = i % BLOCK_SIZE;
  const int z = i % ROWS / BLOCK_SIZE;
  const int3 first_voxel = BLOCK_SIZE * vload3(0, blocks[block].index) + (int3)(0, y, z);
  __global const char* voxels =
      volume + ((block * PADDED_SIZE + z + 1) * PADDED_SIZE + y + 1) * PADDED_SIZE + 1;
  __global float* vertex = vertices + 6 * (size_t)(blocks[block].first_vertex - first_of_batch + rows[i].w);
  const uint edges[3] = {rows[i].x, rows[i].y, rows[i].z};
  const int strides[3] = {1, PADDED_SIZE, PADDED_SIZE * PADDED_SIZE};
  for (int axis = 0; axis < 3; ++axis) {
    const float3 direction = (float3)(axis == 0, axis == 1, axis == 2);
    for (uint left = edges[axis]; left != 0; left &= left - 1, vertex += 6) {
      const int x = lowest_bit(left);
      const float3 corner_vox = convert_float3(first_voxel + (int3)(x, 0, 0));
      emit_vertex(vertex, voxels + x, strides[axis], direction, corner_vox, voxel_size_m);
    }
  }
}
