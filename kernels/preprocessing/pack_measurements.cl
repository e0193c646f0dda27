// How far to trust each pixel. A work-item takes SIMD_WIDTH pixels of a row.
//   normals       0 beside depth edges and where depth is missing
//   weights       a weight a pixel, read with -DWEIGHTS; pixels whose weight is not in (0, 1] are left out
//   measurements  a word a pixel, see types.h
#include "shared/image.h"
#include "shared/measurement.h"
#include "shared/normal.h"

// Across a slanted surface a lateral error is one of depth, too.
inline vfloat accuracy_at(vfloat cosine, vfloat depth_m, const CameraArgs camera, const SensorArgs sensor) {
  const vfloat axial_m = AXIAL_SIGMA_M(sensor, depth_m);
  const vfloat lateral_m = sensor.lateral_sigma_px * depth_m / camera.fx;
  const vfloat squared_tangent = max(1.0f / (cosine * cosine) - 1.0f, (vfloat)(0.0f));
  return axial_m * rsqrt(axial_m * axial_m + lateral_m * lateral_m * squared_tangent);
}

__kernel void pack_measurements(__global const float* depth, __global const uint* normals,
                                __global const float* weights, __global uint* measurements, CameraArgs camera,
                                SensorArgs sensor, float depth_step_m) {
  const int x = get_global_id(0) * SIMD_WIDTH;
  const int y = get_global_id(1);
  if (x >= camera.width) return;
  const int index = pixel_index(x, y, camera);
  Measurement measured;
  measured.depth_m = VLOAD(depth + index);
  const vuint normal = VLOAD(normals + index);
  const Normals n = unpack_normals(normal);
  const vint smooth = normal != 0;
  const vfloat ray_x = (TO_VFLOAT(x + LANE_INDICES) - camera.cx) / camera.fx;
  const float ray_y = (y - camera.cy) / camera.fy;
  const vfloat cosine = -(n.x * ray_x + n.y * ray_y + n.z) * rsqrt(ray_x * ray_x + (ray_y * ray_y + 1.0f));
  measured.cosine = select((vfloat)(1.0f), clamp(cosine, MIN_COSINE, 1.0f), smooth);
  measured.accuracy = select((vfloat)(1.0f / sensor.edge_sigmas),
                             accuracy_at(measured.cosine, measured.depth_m, camera, sensor), smooth);
  vint known = measured.depth_m > 0.0f;
#ifdef WEIGHTS
  const vfloat weight = VLOAD(weights + index);
  known = known & (weight > 0.0f) & (weight <= 1.0f);
  measured.accuracy *= sqrt(weight);
#endif
  VSTORE(select((vuint)(0), pack_measurement(measured, depth_step_m), AS_VUINT(known)), measurements + index);
}
