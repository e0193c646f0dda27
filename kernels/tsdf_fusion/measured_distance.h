// Computes how far in front of the measured surface a point is. FUSION_DISTANCE is DISTANCE_PROJECTIVE,
// DISTANCE_PLANE or DISTANCE_REFINED (see types.h).
#include "shared/image.h"
#include "shared/measurement.h"
#include "shared/normal.h"
#include "tsdf_fusion/block_projection.h"
#ifndef FUSION_DISTANCE
#define FUSION_DISTANCE DISTANCE_PLANE
#endif
#define GRADIENT_STEPS 2
#define MAX_REFINED_RANGE 2.0f  // truncations along the ray; farther points stay projective

typedef struct {
  vfloat distance_m;
  vfloat slope;  // by which the distance grows where the depth does
} MeasuredDistance;

#if FUSION_DISTANCE == DISTANCE_REFINED

typedef struct {
  vint known;
  vfloat distance_m;
  Normals normal;
} TangentPlane;

inline TangentPlane plane_at(vfloat u, vfloat v, Points p, __global const uint* measurements,
                             __global const uint* normals, const CameraArgs camera, float depth_step_m) {
  const vint inside = (u >= 0.0f) & (v >= 0.0f) & (u < camera.width) & (v < camera.height);
  const vint column = TO_VINT(u), row = TO_VINT(v);
  const vint pixel = select((vint)(0), pixel_indices(column, row, camera), inside);
  const vfloat depth = unpack_measurement(GATHER(vuint, measurements, pixel), depth_step_m).depth_m;
  TangentPlane result;
  const vuint normal = GATHER(vuint, normals, pixel);
  result.normal = unpack_normals(normal);
  result.known = (depth > 0.0f) & (normal != 0);
  const vfloat from_x = p.x - (TO_VFLOAT(column) - camera.cx) / camera.fx * depth;
  const vfloat from_y = p.y - (TO_VFLOAT(row) - camera.cy) / camera.fy * depth;
  result.distance_m = result.normal.x * from_x + result.normal.y * from_y + result.normal.z * (p.z - depth);
  return result;
}

// Steps from the point's own pixel along the normals to the pixel where the nearest point of the surface is
// seen.
inline MeasuredDistance measured_distance(Points p, Measurement measured, float ray_length,
                                          __global const uint* measurements, __global const uint* normals,
                                          const CameraArgs camera, float truncation_m, float depth_step_m) {
  const vfloat along_ray_m = (measured.depth_m - p.z) * ray_length;
  const vint near = fabs(along_ray_m) < MAX_REFINED_RANGE * truncation_m;
  MeasuredDistance result = {along_ray_m, 1.0f};
  vfloat x = p.x, y = p.y, z = p.z;
  for (int i = 0; i < GRADIENT_STEPS; ++i) {
    TangentPlane tangent =
        plane_at(camera.fx * x / z + (camera.cx + 0.5f), camera.fy * y / z + (camera.cy + 0.5f), p,
                 measurements, normals, camera, depth_step_m);
    tangent.known = tangent.known & near;
    result.distance_m = select(result.distance_m, tangent.distance_m, tangent.known);
    result.slope = select(result.slope, measured.cosine, tangent.known);
    x = select(x, p.x - tangent.distance_m * tangent.normal.x, tangent.known);
    y = select(y, p.y - tangent.distance_m * tangent.normal.y, tangent.known);
    z = select(z, p.z - tangent.distance_m * tangent.normal.z, tangent.known);
  }
  return result;
}

#else

inline MeasuredDistance measured_distance(Points p, Measurement measured, float ray_length,
                                          __global const uint* measurements, __global const uint* normals,
                                          const CameraArgs camera, float truncation_m, float depth_step_m) {
#if FUSION_DISTANCE == DISTANCE_PLANE
  const vfloat slope = measured.cosine;
#else
  const vfloat slope = 1.0f;
#endif
  const vfloat along_ray_m = (measured.depth_m - p.z) * ray_length;
  const MeasuredDistance result = {along_ray_m * slope, slope};
  return result;
}

#endif
