// Rasterises triangles to depth and normals: first every triangle's depth, of which an atomic keeps the
// nearest of a pixel, then the normals of the triangles that are the nearest. A work-item is a vertex
// (project_vertices), a triangle (all of them, then those drawn) or, at the end, a pixel.
//   vertices    position and normal in W, six floats
//   projected   u, v in pixels, 1 / z, and 0; 1 / z is 0 for a vertex nearer than MIN_Z
//   triangles   three vertices, counter-clockwise seen from free space
//   drawn       numbers of the triangles that are, or were, the nearest of a pixel
//   nearest     depth in metres a pixel; float bits as ints, whose order is the same for positive floats;
//               NO_DEPTH_BITS = none
#include "shared/image.h"
#include "shared/normal.h"

#define MIN_Z 0.02f
// A triangle reaches so many pixels beyond its sides, so that rounding opens no gap between two triangles.
#define SEAM_PX 1e-3f
#define SAME_DEPTH 1.00001f

__kernel void project_vertices(__global float4* projected, __global const float* vertices, int count,
                               CameraArgs camera, TransformArgs T_D_W) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const float3 p = transform_point(T_D_W, vload3(2 * i, vertices));
  const float inverse_z = p.z > MIN_Z ? 1.0f / p.z : 0.0f;
  projected[i] = (float4)(camera.fx * p.x * inverse_z + camera.cx, camera.fy * p.y * inverse_z + camera.cy,
                          inverse_z, 0.0f);
}

typedef struct {
  float4 a, b, c;
  float per_area;      // of twice the area in pixels
  int x0, y0, x1, y1;  // pixels that the triangle may cover; none if x1 < x0 or y1 < y0
  float tolerance;     // of the weights
} ScreenTriangle;

inline ScreenTriangle screen_triangle(__global const float4* projected, __global const uint* triangles, int i,
                                      const CameraArgs camera) {
  const uint3 corners = vload3(i, triangles);
  ScreenTriangle t;
  t.a = projected[corners.x];
  t.b = projected[corners.y];
  t.c = projected[corners.z];
  const float2 ab = t.b.xy - t.a.xy, ac = t.c.xy - t.a.xy;
  const float area = ab.y * ac.x - ab.x * ac.y;  // positive if the front is seen
  t.per_area = 1.0f / area;
  const float2 low = fmin(t.a.xy, fmin(t.b.xy, t.c.xy)) - SEAM_PX,
               high = fmax(t.a.xy, fmax(t.b.xy, t.c.xy)) + SEAM_PX;
  const int seen = area > 0.0f && t.a.z > 0.0f && t.b.z > 0.0f && t.c.z > 0.0f && high.x >= 0.0f &&
                   high.y >= 0.0f && low.x <= camera.width - 1 && low.y <= camera.height - 1;
  t.x0 = seen ? max((int)ceil(low.x), 0) : 0;
  t.y0 = seen ? max((int)ceil(low.y), 0) : 0;
  t.x1 = seen ? (int)fmin(high.x, camera.width - 1.0f) : -1;
  t.y1 = seen ? (int)fmin(high.y, camera.height - 1.0f) : -1;
  t.tolerance = SEAM_PX * (high.x - low.x + high.y - low.y) * t.per_area;
  return t;
}

// Returns the barycentric weights of the pixel's centre.
inline float3 weights_at(const ScreenTriangle t, int x, int y) {
  const float2 p = (float2)(x, y) - t.a.xy;
  const float2 ab = t.b.xy - t.a.xy, ac = t.c.xy - t.a.xy;
  const float of_b = (p.y * ac.x - p.x * ac.y) * t.per_area;
  const float of_c = (ab.y * p.x - ab.x * p.y) * t.per_area;
  return (float3)(1.0f - of_b - of_c, of_b, of_c);
}

inline bool covers(const ScreenTriangle t, float3 weights) {
  return fmin(weights.x, fmin(weights.y, weights.z)) >= -t.tolerance;
}

inline float depth_at(const ScreenTriangle t, float3 weights) {
  const float inverse_z = weights.x * t.a.z + weights.y * t.b.z + weights.z * t.c.z;
  return 1.0f / clamp(inverse_z, fmin(t.a.z, fmin(t.b.z, t.c.z)), fmax(t.a.z, fmax(t.b.z, t.c.z)));
}

// Lists the triangles that were the nearest of a pixel at some time; many others are smaller than a pixel and
// cover none. The pixels that they cover lose their normals.
__kernel void rasterise_depth(__global uint* normals, __global int* nearest, __global int* drawn,
                              __global int* drawn_count, __global const float4* projected,
                              __global const uint* triangles, int count, CameraArgs camera, float min_range_m,
                              float max_range_m) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const ScreenTriangle t = screen_triangle(projected, triangles, i, camera);
  bool is_drawn = false;
  for (int y = t.y0; y <= t.y1; ++y) {
    for (int x = t.x0; x <= t.x1; ++x) {
      const float3 weights = weights_at(t, x, y);
      const float z = depth_at(t, weights);
      if (!covers(t, weights) || !(z >= min_range_m && z <= max_range_m)) continue;
      __global int* pixel = nearest + pixel_index(x, y, camera);
      if (as_int(z) >= *pixel || as_int(z) >= atomic_min(pixel, as_int(z))) continue;
      atomic_xchg(normals + pixel_index(x, y, camera), 0);
      is_drawn = true;
    }
  }
  if (is_drawn) drawn[atomic_inc(drawn_count)] = i;
}

// The normals are in frame D. Where triangles share an edge, the largest word stays, whichever comes first.
__kernel void rasterise_normals(__global uint* normals, __global const int* nearest,
                                __global const int* drawn, __global const float4* projected,
                                __global const float* vertices, __global const uint* triangles, int count,
                                CameraArgs camera, TransformArgs T_D_W) {
  if (get_global_id(0) >= count) return;
  const int i = drawn[get_global_id(0)];
  const ScreenTriangle t = screen_triangle(projected, triangles, i, camera);
  for (int y = t.y0; y <= t.y1; ++y) {
    for (int x = t.x0; x <= t.x1; ++x) {
      const float3 weights = weights_at(t, x, y);
      const int index = pixel_index(x, y, camera);
      if (!covers(t, weights) || depth_at(t, weights) > SAME_DEPTH * as_float(nearest[index])) continue;
      const uint3 corners = vload3(i, triangles);
      const float3 normal_W = weights.x * t.a.z * vload3(2 * corners.x + 1, vertices) +
                              weights.y * t.b.z * vload3(2 * corners.y + 1, vertices) +
                              weights.z * t.c.z * vload3(2 * corners.z + 1, vertices);
      atomic_max(normals + index, pack_normal(rotate_point(T_D_W, normal_W)));
    }
  }
}

// Writes the view's depth: `nearest` as metres, 0 where there is no triangle.
__kernel void resolve_depth(__global float* depth, __global const int* nearest, CameraArgs camera) {
  const int x = get_global_id(0);
  const int y = get_global_id(1);
  if (x >= camera.width) return;
  const int index = pixel_index(x, y, camera);
  depth[index] = nearest[index] == NO_DEPTH_BITS ? 0.0f : as_float(nearest[index]);
}
