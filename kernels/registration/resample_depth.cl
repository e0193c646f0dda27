// Computes the depth that another camera, a pinhole one, would measure. Each of its pixels looks up where the
// depth camera saw what lies on its ray, and interpolates between those of the four pixels there that see one
// surface. Averages of noise stay averages in this way, where the nearest of several pixels would be too
// near. A work-item takes SIMD_WIDTH pixels of a row.
//   depth    of the depth camera D as its lens distorts it, metres, 0 = none
//   result   of the other camera C, metres, 0 = none
#include "shared/image.h"

#define ITERATIONS 4
#define CONVERGED 1e-4f  // the change of the depth, as a part of it

// Computes where a lens takes the ray (x, y, 1).
inline void distort(const LensArgs lens, vfloat* x, vfloat* y) {
  const vfloat u = *x, v = *y;
  const vfloat r2 = u * u + v * v;
  const vfloat numerator = 1.0f + r2 * (lens.radial[0] + r2 * (lens.radial[1] + r2 * lens.radial[2]));
  const vfloat denominator = 1.0f + r2 * (lens.radial[3] + r2 * (lens.radial[4] + r2 * lens.radial[5]));
  const vfloat radial = numerator / denominator;
  const float p1 = lens.tangential[0], p2 = lens.tangential[1];
  *x = u * radial + 2.0f * p1 * u * v + p2 * (r2 + 2.0f * u * u);
  *y = v * radial + p1 * (r2 + 2.0f * v * v) + 2.0f * p2 * u * v;
  // Farther out the polynomial may turn back.
  *x = select((vfloat)(-MAXFLOAT), *x, r2 <= lens.max_squared_radius);
}

// Returns the depth camera's depth along its ray (x, y, 1).
inline vfloat depth_along(vfloat x, vfloat y, __global const float* depth, const CameraArgs camera,
                          const LensArgs lens, float max_relative_step) {
  distort(lens, &x, &y);
  const vfloat u = camera.fx * x + camera.cx;
  const vfloat v = camera.fy * y + camera.cy;
  const vint inside = (u > -0.5f) & (u < camera.width - 0.5f) & (v > -0.5f) & (v < camera.height - 0.5f);
  const vfloat u0 = floor(u), v0 = floor(v);
  const vfloat fu = u - u0, fv = v - v0;
  const vint column = select((vint)(0), TO_VINT(u0), inside);  // -1 and the width lie in the image's margin
  const vint row = select((vint)(0), TO_VINT(v0), inside);
  const vint upper = pixel_indices(column, max(row, (vint)(0)), camera);
  const vint lower = pixel_indices(column, min(row + 1, (vint)(camera.height - 1)), camera);
  const vfloat z00 = GATHER(vfloat, depth, upper), z10 = GATHER(vfloat, depth, upper + 1);
  const vfloat z01 = GATHER(vfloat, depth, lower), z11 = GATHER(vfloat, depth, lower + 1);
  const vfloat nearest = select(select(z00, z10, fu >= 0.5f), select(z01, z11, fu >= 0.5f), fv >= 0.5f);
  const vfloat limit = max_relative_step * nearest;
  vfloat sum = 0.0f, weights = 0.0f;
  const vfloat four[4] = {z00, z10, z01, z11};
  for (int i = 0; i < 4; ++i) {
    const vfloat share = ((i & 1) ? fu : 1.0f - fu) * ((i & 2) ? fv : 1.0f - fv);
    const vfloat weight = select((vfloat)(0.0f), share, fabs(four[i] - nearest) <= limit);
    sum += weight * four[i];
    weights += weight;
  }
  return select((vfloat)(0.0f), sum / weights, inside & (nearest > 0.0f));
}

// Serves a camera C that is D without its lens.
__kernel void rectify_depth(__global const float* depth, __global float* result, CameraArgs camera,
                            LensArgs lens, CameraArgs other_camera, float max_relative_step) {
  const int x = get_global_id(0) * SIMD_WIDTH;
  const int y = get_global_id(1);
  if (x >= other_camera.width) return;
  const vint column = x + LANE_INDICES;
  const vfloat ray_x = (TO_VFLOAT(column) - other_camera.cx) / other_camera.fx;
  const vfloat ray_y = (vfloat)((y - other_camera.cy) / other_camera.fy);
  const vfloat z = depth_along(ray_x, ray_y, depth, camera, lens, max_relative_step);
  VSTORE(select((vfloat)(0.0f), z, column < other_camera.width), result + pixel_index(x, y, other_camera));
}

// Serves a camera C that stands beside D. Which of D's pixels a ray meets depends on the depth itself, so
// that the search begins with the nearest of the splatted depths around. A ray that meets none of them, or
// none that the others agree with, has no depth.
//   splatted  D's depth at C's pixels, one pixel each, the nearest; float bits or NO_DEPTH_BITS
//   radius    pixels of C between one of D's and the next at most
__kernel void register_depth(__global const float* depth, __global const int* splatted,
                             __global float* result, CameraArgs camera, LensArgs lens,
                             CameraArgs other_camera, TransformArgs T_D_C, int radius,
                             float max_relative_step) {
  const int x = get_global_id(0) * SIMD_WIDTH;
  const int y = get_global_id(1);
  if (x >= other_camera.width) return;
  const vint column = x + LANE_INDICES;
  vint nearest = NO_DEPTH_BITS;
  for (int row = max(y - radius, 0); row <= min(y + radius, other_camera.height - 1); ++row) {
    for (int dx = -radius; dx <= radius; ++dx) {
      nearest = min(nearest, VLOAD(splatted + pixel_index(x + dx, row, other_camera)));
    }
  }
  const vint some = (nearest != NO_DEPTH_BITS) & (column < other_camera.width);
  vfloat z = select((vfloat)(1.0f), AS_VFLOAT(nearest), some);
  vfloat step = 0.0f;
  if (ANY(some)) {
    const vfloat ray_x = (TO_VFLOAT(column) - other_camera.cx) / other_camera.fx;
    const vfloat ray_y = (vfloat)((y - other_camera.cy) / other_camera.fy);
    const vfloat one = 1.0f;
    const vfloat ray_D_x = rotated(T_D_C, 0, ray_x, ray_y, one);
    const vfloat ray_D_y = rotated(T_D_C, 1, ray_x, ray_y, one);
    const vfloat ray_D_z = rotated(T_D_C, 2, ray_x, ray_y, one);
    for (int i = 0; i < ITERATIONS; ++i) {
      const vfloat z_D = z * ray_D_z + T_D_C.translation[2];
      const vfloat seen =
          depth_along((z * ray_D_x + T_D_C.translation[0]) / z_D, (z * ray_D_y + T_D_C.translation[1]) / z_D,
                      depth, camera, lens, max_relative_step);
      const vfloat next =
          select((vfloat)(0.0f), (seen - T_D_C.translation[2]) / ray_D_z, (z_D > 0.0f) & (seen > 0.0f));
      step = select(next - z, (vfloat)(MAXFLOAT), next <= 0.0f);
      z = select(z, next, next > 0.0f);
      if (!ANY(some & (fabs(step) > CONVERGED * z) & (step < MAXFLOAT))) break;
    }
  }
  const vint agreed = some & (fabs(step) <= max_relative_step * z);
  VSTORE(select((vfloat)(0.0f), z, agreed), result + pixel_index(x, y, other_camera));
}
