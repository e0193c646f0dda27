// Arguments and codes of the distance field's kernels, compiled by host and device alike.
#ifndef DEPTH_FUSION_ESDF_TYPES_H
#define DEPTH_FUSION_ESDF_TYPES_H
#include "shared/types.h"

// The cells of the distance field are cubes of cell_voxels^3 voxels, in blocks of ESDF_BLOCK^3 cells. A
// cell's site is the voxel on the surface that is nearest to the cell's middle: the square of its distance
// from there, in voxels, above ESDF_SITE_BITS bits that say which voxel of the cell it is, five an axis.
#define ESDF_BLOCK 16
#define ESDF_CELLS 4096
#define ESDF_MAX_CELL_VOXELS 32
#define ESDF_NO_SITE (-1)
#define ESDF_SITE_BITS 15
#define ESDF_MAX_REACH 119     // cells
#define ESDF_NOWHERE 127       // an offset to a site, where there is none
#define ESDF_UNKNOWN (-32768)  // of distances

// How often a cell was seen to be free of late: from ESDF_FREE times on it is.
#define ESDF_FREE 3
#define ESDF_FREE_MAX 12

// What has changed in a block of cells.
#define ESDF_SITES_CHANGED 1
#define ESDF_KNOWN_CHANGED 2

typedef struct {
  float cell_m, voxel_m, truncation_m;
  int cell_voxels;
  int surface_steps;     // the largest distance byte of a voxel that counts as on the surface
  int reach;             // cells up to which sites are looked for, in each axis
  float max_distance_m;  // a cell without a nearer site has this distance
  float steps_per_m;     // of the distances
  float hidden_m;        // how far behind a surface a cell is doubted
} EsdfArgs;

// The blocks of cells that a part of the distance field is computed from, and, inside, the cells that it is
// computed of; in cells from the first one of those blocks.
typedef struct {
  int blocks[3];
  int first[3];
  int size[3];
} EsdfRegionArgs;

#endif
