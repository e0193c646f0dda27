// Pixels, points and rigid motions.
#include "shared/simd.h"
#include "shared/types.h"

inline int pixel_index(int x, int y, const CameraArgs camera) { return IMAGE_GUARD + y * camera.pitch + x; }
inline vint pixel_indices(vint x, vint y, const CameraArgs camera) { return IMAGE_GUARD + y * camera.pitch + x; }

inline float3 rotate_point(const TransformArgs T, float3 p) {
  return (float3)(T.rotation[0] * p.x + T.rotation[1] * p.y + T.rotation[2] * p.z,
                  T.rotation[3] * p.x + T.rotation[4] * p.y + T.rotation[5] * p.z,
                  T.rotation[6] * p.x + T.rotation[7] * p.y + T.rotation[8] * p.z);
}

inline float3 transform_point(const TransformArgs T, float3 p) {
  return rotate_point(T, p) + (float3)(T.translation[0], T.translation[1], T.translation[2]);
}

// Component `row` of the rotated vectors, one a lane.
inline vfloat rotated(const TransformArgs T, int row, vfloat x, vfloat y, vfloat z) {
  return T.rotation[3 * row] * x + T.rotation[3 * row + 1] * y + T.rotation[3 * row + 2] * z;
}
