// Pixels, points and rigid motions.
#include "shared/simd.h"
#include "shared/types.h"

inline int pixel_index(int x, int y, const CameraArgs camera) { return IMAGE_GUARD + y * camera.pitch + x; }
inline vint pixel_indices(vint x, vint y, const CameraArgs camera) {
  return IMAGE_GUARD + y * camera.pitch + x;
}

inline float3 rotate_point(const TransformArgs T, float3 p) {
  return (float3)(T.rotation[0] * p.x + T.rotation[1] * p.y + T.rotation[2] * p.z,
                  T.rotation[3] * p.x + T.rotation[4] * p.y + T.rotation[5] * p.z,
                  T.rotation[6] * p.x + T.rotation[7] * p.y + T.rotation[8] * p.z);
}

inline float3 transform_point(const TransformArgs T, float3 p) {
  return rotate_point(T, p) + (float3)(T.translation[0], T.translation[1], T.translation[2]);
}

// Tells whether a sphere, given in the camera's frame, reaches into what the camera sees: ahead of the
// camera, and on the inner side of the planes through its image's borders.
inline bool sphere_in_view(float3 centre, float radius, const CameraArgs camera) {
  const float left = camera.cx + 1.0f, right = camera.width - camera.cx;
  const float top = camera.cy + 1.0f, bottom = camera.height - camera.cy;
  const float x = camera.fx * centre.x, y = camera.fy * centre.y, z = centre.z;
  const float fx2 = camera.fx * camera.fx, fy2 = camera.fy * camera.fy;
  return z > -radius && x + left * z > -radius * sqrt(fx2 + left * left) &&
         right * z - x > -radius * sqrt(fx2 + right * right) &&
         y + top * z > -radius * sqrt(fy2 + top * top) &&
         bottom * z - y > -radius * sqrt(fy2 + bottom * bottom);
}

// Returns component `row` of the rotated vectors, one vector a lane.
inline vfloat rotated(const TransformArgs T, int row, vfloat x, vfloat y, vfloat z) {
  return T.rotation[3 * row] * x + T.rotation[3 * row + 1] * y + T.rotation[3 * row + 2] * z;
}
