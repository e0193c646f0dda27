// Where the voxels of a block lie in the depth image. A pixel's coordinates times its depth, and the depth, are linear in
// the voxel's place in the block.
#include "shared/block_map.h"
#include "shared/image.h"

// Points in frame D, one a lane.
typedef struct {
  vfloat x, y, z;
} Points;

typedef struct {
  float3 corner;                // (u z, v z, z) of voxel 0
  float3 row_u, row_v, row_z;   // by which they grow, a voxel along each axis
  vfloat lane_u, lane_v, lane_z;  // by which those of a vector's voxels differ from those of its first
} BlockProjection;

inline BlockProjection block_projection(int3 block, const TransformArgs T_D_W, const CameraArgs camera,
                                        float voxel_size_m) {
  const float3 rows_x = voxel_size_m * (float3)(T_D_W.rotation[0], T_D_W.rotation[1], T_D_W.rotation[2]);
  const float3 rows_y = voxel_size_m * (float3)(T_D_W.rotation[3], T_D_W.rotation[4], T_D_W.rotation[5]);
  const float3 corner = transform_point(T_D_W, convert_float3(block * BLOCK_SIZE) * voxel_size_m);
  const float cu = camera.cx + 0.5f, cv = camera.cy + 0.5f;
  BlockProjection p;
  p.corner = (float3)(camera.fx * corner.x + cu * corner.z, camera.fy * corner.y + cv * corner.z, corner.z);
  p.row_z = voxel_size_m * (float3)(T_D_W.rotation[6], T_D_W.rotation[7], T_D_W.rotation[8]);
  p.row_u = camera.fx * rows_x + cu * p.row_z;
  p.row_v = camera.fy * rows_y + cv * p.row_z;
  const vfloat lane_i = TO_VFLOAT(LANE_INDICES & (BLOCK_SIZE - 1));
  const vfloat lane_j = TO_VFLOAT(LANE_INDICES >> BLOCK_SIZE_LOG2);
  p.lane_u = p.row_u.x * lane_i + p.row_u.y * lane_j;
  p.lane_v = p.row_v.x * lane_i + p.row_v.y * lane_j;
  p.lane_z = p.row_z.x * lane_i + p.row_z.y * lane_j;
  return p;
}

// (u z, v z, z) of a vector of voxels.
inline Points scaled_pixels(const BlockProjection p, int first_voxel) {
  const float i = first_voxel & (BLOCK_SIZE - 1);
  const float j = (first_voxel >> BLOCK_SIZE_LOG2) & (BLOCK_SIZE - 1);
  const float k = first_voxel >> (2 * BLOCK_SIZE_LOG2);
  const Points result = {p.lane_u + (p.corner.x + p.row_u.x * i + p.row_u.y * j + p.row_u.z * k),
                         p.lane_v + (p.corner.y + p.row_v.x * i + p.row_v.y * j + p.row_v.z * k),
                         p.lane_z + (p.corner.z + p.row_z.x * i + p.row_z.y * j + p.row_z.z * k)};
  return result;
}

// Indices of the pixels that a vector of voxels is seen at; 0, in the image's guard, where it is not in view.
inline vint voxel_pixels(const BlockProjection p, int first_voxel, const CameraArgs camera) {
  const Points scaled = scaled_pixels(p, first_voxel);
  const vfloat per_z = 1.0f / scaled.z;
  const vfloat u = scaled.x * per_z;
  const vfloat v = scaled.y * per_z;
  const vint in_view = (scaled.z > 0.0f) & (u >= 0.0f) & (u < camera.width) & (v >= 0.0f) & (v < camera.height);
  return select((vint)(0), pixel_indices(TO_VINT(u), TO_VINT(v), camera), in_view);
}

inline Points voxel_points(const BlockProjection p, int first_voxel, const CameraArgs camera) {
  const Points scaled = scaled_pixels(p, first_voxel);
  const Points result = {(scaled.x - (camera.cx + 0.5f) * scaled.z) / camera.fx,
                         (scaled.y - (camera.cy + 0.5f) * scaled.z) / camera.fy, scaled.z};
  return result;
}
