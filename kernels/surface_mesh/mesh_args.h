// Kernel arguments of the surface mesh, compiled by host and device alike: members of four bytes only.
#ifndef DEPTH_FUSION_SURFACE_MESH_MESH_ARGS_H
#define DEPTH_FUSION_SURFACE_MESH_MESH_ARGS_H

// A block of a batch. Only the first blocks of a batch, the core, emit; the others lend them their vertices.
typedef struct {
  int index[3];
  int slot;                 // in the voxel pool
  unsigned first_vertex;    // of the whole mesh
  unsigned first_triangle;  // of the batch
  int neighbours[8];        // place in the batch of the block (n & 1, n >> 1 & 1, n >> 2 & 1) farther, -1 if not there
} MeshBlockArgs;

#endif
