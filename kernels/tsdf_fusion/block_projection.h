// Says where the voxels of a block lie in the depth image. A pixel's coordinates times its depth, and the
// depth, are linear in the voxel's place in the block.
#include "shared/block_items.h"
#include "shared/image.h"

// A work-item's voxels go by parts of as many as a small block's slice.
#define PART_VOXELS (ITEM_VOXELS < 64 ? ITEM_VOXELS : 64)
#define PART_VECTORS (PART_VOXELS / SIMD_WIDTH)

// Holds points in frame D, one a lane.
typedef struct {
  vfloat x, y, z;
} Points;

typedef struct {
  float3 row_u, row_v, row_z;       // by which (u z, v z, z) grow, a voxel along each axis
  Points first_part[PART_VECTORS];  // (u z, v z, z) of the block's first voxels
} BlockProjection;

// Returns by how much (u z, v z, z) of voxels differ from those of voxel 0.
inline Points from_first_voxel(const BlockProjection* p, vint voxel) {
  const vfloat i = TO_VFLOAT(voxel & (BLOCK_SIZE - 1));
  const vfloat j = TO_VFLOAT(voxel >> BLOCK_SIZE_LOG2 & (BLOCK_SIZE - 1));
  const vfloat k = TO_VFLOAT(voxel >> (2 * BLOCK_SIZE_LOG2));
  const Points result = {p->row_u.x * i + p->row_u.y * j + p->row_u.z * k,
                         p->row_v.x * i + p->row_v.y * j + p->row_v.z * k,
                         p->row_z.x * i + p->row_z.y * j + p->row_z.z * k};
  return result;
}

inline Points sum_of(Points a, Points b) {
  const Points sum = {a.x + b.x, a.y + b.y, a.z + b.z};
  return sum;
}

inline BlockProjection block_projection(int3 block, const TransformArgs T_D_W, const CameraArgs camera,
                                        float voxel_size_m) {
  const float3 rows_x = voxel_size_m * (float3)(T_D_W.rotation[0], T_D_W.rotation[1], T_D_W.rotation[2]);
  const float3 rows_y = voxel_size_m * (float3)(T_D_W.rotation[3], T_D_W.rotation[4], T_D_W.rotation[5]);
  const float3 corner = transform_point(T_D_W, convert_float3(block * BLOCK_SIZE) * voxel_size_m);
  const float cu = camera.cx + 0.5f, cv = camera.cy + 0.5f;
  BlockProjection p;
  p.row_z = voxel_size_m * (float3)(T_D_W.rotation[6], T_D_W.rotation[7], T_D_W.rotation[8]);
  p.row_u = camera.fx * rows_x + cu * p.row_z;
  p.row_v = camera.fy * rows_y + cv * p.row_z;
  const Points first = {camera.fx * corner.x + cu * corner.z, camera.fy * corner.y + cv * corner.z, corner.z};
  for (int i = 0; i < PART_VECTORS; ++i) {
    p.first_part[i] = sum_of(first, from_first_voxel(&p, i * SIMD_WIDTH + LANE_INDICES));
  }
  return p;
}

// Returns the indices of the pixels that points (u z, v z, z) are seen at; 0, which lies in the image's
// guard, where they are not in view.
inline vint pixels_of(Points scaled, const CameraArgs camera) {
  const vfloat per_z = 1.0f / scaled.z;
  const vfloat u = scaled.x * per_z;
  const vfloat v = scaled.y * per_z;
  const vint in_view =
      (scaled.z > 0.0f) & (u >= 0.0f) & (u < camera.width) & (v >= 0.0f) & (v < camera.height);
  return select((vint)(0), pixel_indices(TO_VINT(u), TO_VINT(v), camera), in_view);
}

inline Points unscaled(Points scaled, const CameraArgs camera) {
  const Points result = {(scaled.x - (camera.cx + 0.5f) * scaled.z) / camera.fx,
                         (scaled.y - (camera.cy + 0.5f) * scaled.z) / camera.fy, scaled.z};
  return result;
}
