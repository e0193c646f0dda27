// Kernel arguments, compiled by host and device alike: members of four bytes only, so that both lay them out alike
// (test/unit/shared_types_test.cpp compares the layouts).
#ifndef DEPTH_FUSION_SHARED_TYPES_H
#define DEPTH_FUSION_SHARED_TYPES_H

// Values of a voxel's distance byte, and of an entry of the offset buffer.
#define TSDF_CHI (-128)        // no surface near (the paper's chi)
#define TSDF_MAX 127           // the distance +truncation
#define BLOCK_EMPTY (-1)       // no memory allocated
#define BLOCK_REQUESTED (-2)   // claimed by block selection, to be allocated by the host

// Bits of a block's state byte, written by TSDF fusion.
#define BLOCK_HAS_DATA 1       // some voxel is not chi
#define BLOCK_NEAR_SURFACE 2   // some voxel lies within a voxel's diagonal of the surface

// A pinhole camera and its planar images: `pitch` elements a row, a multiple of 16.
typedef struct {
  float fx, fy, cx, cy;
  int width, height, pitch;
} CameraArgs;

// p_A = rotation * p_B + translation, row by row.
typedef struct {
  float rotation[9];
  float translation[3];
} TransformArgs;

// The window of blocks_per_axis^3 blocks of block_size^3 voxels. Voxel (i, j, k) samples the point
// voxel_size_m * (i, j, k) of W. A block's address wraps around: index modulo blocks_per_axis in each axis.
typedef struct {
  float voxel_size_m;
  float truncation_m;
  int blocks_per_axis;
  int origin[3];          // first block of the window
  int wrapped_origin[3];  // origin modulo blocks_per_axis
} GridArgs;

#endif
