// Ray casting of the block-sparse map, as the paper has it: a ray is followed to the voxel where the distance
// first goes from positive to negative; trilinear interpolation finds the surface and its normal there. One
// ray of every 2x2 pixels is followed. The others look for the surface where its plane meets them, and are
// followed if it is not there; they show nothing where the first one met nothing. So what is narrower than
// two pixels may be missing, or be taken for what lies behind it.
#include "model_view/ray_march.h"
#include "model_view/trilinear.h"
#include "shared/normal.h"
#define PATCH_COLUMNS RAY_PATCH_COLUMNS(SIMD_WIDTH)
#define PATCHES RAY_PATCHES(SIMD_WIDTH)
#define PATCH_RAYS (RAY_STRIDE * RAY_STRIDE)

// `t` is the depth in metres; the gradient is that of the distance in frame W, in steps of the distance byte
// a voxel; `known` is 0 where there is no surface.
typedef struct {
  vfloat t, gradient_x, gradient_y, gradient_z;
  vint known;
} Surface;

inline vfloat along(const Rays rays, const Surface surface) {
  return surface.gradient_x * rays.direction_x + surface.gradient_y * rays.direction_y +
         surface.gradient_z * rays.direction_z;
}

// Finds the surface by one Newton step from t, which is at most about a voxel away from it.
inline Surface find_surface(const Rays rays, vfloat t, vint active, const Point origin,
                            __global const int* offsets, __global const char* voxels, const GridArgs grid) {
  const Sample sample = interpolate(origin.x + t * rays.direction_x, origin.y + t * rays.direction_y,
                                    origin.z + t * rays.direction_z, active, offsets, voxels, grid);
  Surface surface = {t, sample.gradient_x, sample.gradient_y, sample.gradient_z, sample.known};
  const vfloat slope = along(rays, surface);
  const vfloat limit_t = 1.5f * rays.t_per_voxel;
  surface.t -= clamp(sample.value / slope, -limit_t, limit_t);
  surface.known &= slope < 0.0f;
  return surface;
}

// Finds the surface on rays a pixel beside the first ones, where they meet its plane; it counts as known if
// it lies within a voxel of the plane.
inline Surface find_beside(const Rays rays, const Rays first_rays, const Surface first, vint in_view,
                           const Point origin, __global const int* offsets, __global const char* voxels,
                           const GridArgs grid) {
  const vfloat t = first.t * along(first_rays, first) / along(rays, first);
  const vint expected = in_view & first.known & (fabs(t - first.t) < 3.0f * rays.t_per_voxel);
  Surface surface = find_surface(rays, t, expected, origin, offsets, voxels, grid);
  surface.known &= fabs(surface.t - t) < rays.t_per_voxel;
  return surface;
}

// Stores rows of words; `even` holds those of the pixels with even columns, `odd` those with odd ones.
inline void store_rows(vuint even, vuint odd, int x, int y, __global uint* image, const CameraArgs camera) {
#if SIMD_WIDTH == 1
  if (y >= camera.height) return;
  image[pixel_index(x, y, camera)] = even;
  image[pixel_index(x + 1, y, camera)] = odd;
#else
  uint evens[SIMD_WIDTH], odds[SIMD_WIDTH];
  VSTORE(even, evens);
  VSTORE(odd, odds);
  for (int i = 0; i < SIMD_WIDTH / 4 && y + RAY_STRIDE * i < camera.height; ++i) {
    const uint4 a = vload4(i, evens), b = vload4(i, odds);
    const uint8 row = (uint8)(a.s0, b.s0, a.s1, b.s1, a.s2, b.s2, a.s3, b.s3);
    vstore8(row, 0, image + pixel_index(x, y + RAY_STRIDE * i, camera));
  }
#endif
}

// Returns component i of the gradient in frame D, by the rotation's transpose.
inline vfloat gradient_component(const Surface surface, int i, const TransformArgs T_W_D) {
  return T_W_D.rotation[i] * surface.gradient_x + T_W_D.rotation[3 + i] * surface.gradient_y +
         T_W_D.rotation[6 + i] * surface.gradient_z;
}

inline vuint depth_bits(const Surface surface) {
  return AS_VUINT(select((vfloat)(0.0f), surface.t, surface.known));
}

inline vuint normal_bits(const Surface surface, const TransformArgs T_W_D) {
  const vuint normals =
      pack_normals(gradient_component(surface, 0, T_W_D), gradient_component(surface, 1, T_W_D),
                   gradient_component(surface, 2, T_W_D));
  return select((vuint)(0), normals, AS_VUINT(surface.known));
}

inline void store_surfaces(const Surface even, const Surface odd, int x, int y, __global float* depth,
                           __global uint* normals, const CameraArgs camera, const TransformArgs T_W_D) {
  store_rows(depth_bits(even), depth_bits(odd), x, y, (__global uint*)depth, camera);
  store_rows(normal_bits(even, T_W_D), normal_bits(odd, T_W_D), x, y, normals, camera);
}

// Lists pixels whose rays are yet to be followed, as column and row, 16 bits each. A patch has few of them,
// so that those of all the patches are put together into vectors.
typedef struct {
  uint pixels[PATCHES * (PATCH_RAYS - 1) * SIMD_WIDTH + SIMD_WIDTH];
  int count;
} PixelList;

inline void append(PixelList* list, vint column, vint row, vint wanted) {
  if (!ANY(wanted)) return;
  uint pixels[SIMD_WIDTH];
  int is_wanted[SIMD_WIDTH];
  VSTORE(AS_VUINT(column | row << 16), pixels);
  VSTORE(wanted, is_wanted);
  for (int i = 0; i < SIMD_WIDTH; ++i) {
    list->pixels[list->count] = pixels[i];
    list->count += is_wanted[i] != 0;
  }
}

// Stores a word for each pixel that is `wanted`.
inline void scatter(vuint words, vint pixels, vint wanted, __global uint* image) {
  uint word[SIMD_WIDTH];
  int pixel[SIMD_WIDTH], is_wanted[SIMD_WIDTH];
  VSTORE(words, word);
  VSTORE(pixels, pixel);
  VSTORE(wanted, is_wanted);
  for (int i = 0; i < SIMD_WIDTH; ++i) {
    if (is_wanted[i]) image[pixel[i]] = word[i];
  }
}

// Follows the rays of listed pixels, which lie in tiles with the given bins.
inline void cast_listed(const PixelList* list, ulong bins, const Point origin, __global const int* offsets,
                        __global const char* voxels, __global const float* nearest, __global float* depth,
                        __global uint* normals, const CameraArgs camera, const TransformArgs T_W_D,
                        const GridArgs grid, const RayRangeArgs range) {
  for (int i = 0; i < list->count; i += SIMD_WIDTH) {
    const vint listed = i + LANE_INDICES < list->count;
    const vuint pixels = select((vuint)(0), VLOAD(list->pixels + i), AS_VUINT(listed));
    const vint column = AS_VINT(pixels & 0xffffu), row = AS_VINT(pixels >> 16);
    const vfloat start_m = GATHER(vfloat, nearest, tiles_of(column, row, camera));
    March march = begin_march(make_rays(column, row, camera, T_W_D, grid), listed, start_m, bins, range);
    follow(&march, 1, origin, offsets, voxels, grid, range);
    const Surface surface =
        find_surface(march.rays, march.hit_t, march.hit_t > 0.0f, origin, offsets, voxels, grid);
    const vint indices = pixel_indices(column, row, camera);
    scatter(depth_bits(surface), indices, surface.known, (__global uint*)depth);
    scatter(normal_bits(surface, T_W_D), indices, surface.known, normals);
  }
}

// Writes depth in metres, 0 where there is none, and normals in frame D that point to free space.
__kernel void raycast(__global const int* offsets, __global const char* voxels, __global const float* nearest,
                      __global const uint* occupied, __global float* depth, __global uint* normals,
                      CameraArgs camera, TransformArgs T_W_D, GridArgs grid, RayRangeArgs range) {
  const int x = get_global_id(0) * (PATCHES * RAY_STRIDE * PATCH_COLUMNS);
  const int y = get_global_id(1) * (RAY_STRIDE * SIMD_WIDTH / PATCH_COLUMNS);
  if (x >= camera.width || y >= camera.height) return;
  const Point origin = ray_origin(T_W_D, grid);
  const vint u = x + RAY_STRIDE * (LANE_INDICES % PATCH_COLUMNS);
  const vint v = y + RAY_STRIDE * (LANE_INDICES / PATCH_COLUMNS);

  March firsts[PATCHES];
  ulong all_bins = 0;
  for (int i = 0; i < PATCHES; ++i) {
    const vint column = u + i * (RAY_STRIDE * PATCH_COLUMNS);
    const vint in_view = (column < camera.width) & (v < camera.height);
    const int tile = FIRST_LANE(tiles_of(column, v, camera));
    const ulong bins = bins_of(tile, occupied);
    all_bins |= bins;
    firsts[i] =
        begin_march(make_rays(column, v, camera, T_W_D, grid), in_view, (vfloat)(nearest[tile]), bins, range);
  }
  follow(firsts, PATCHES, origin, offsets, voxels, grid, range);

  PixelList missing;
  missing.count = 0;
  for (int i = 0; i < PATCHES; ++i) {
    const int patch_x = x + i * (RAY_STRIDE * PATCH_COLUMNS);
    const Rays first_rays = firsts[i].rays;
    Surface surfaces[PATCH_RAYS];
    surfaces[0] =
        find_surface(first_rays, firsts[i].hit_t, firsts[i].hit_t > 0.0f, origin, offsets, voxels, grid);
    for (int k = 1; k < PATCH_RAYS; ++k) {
      const vint column = u + (i * (RAY_STRIDE * PATCH_COLUMNS) + k % RAY_STRIDE), row = v + k / RAY_STRIDE;
      const vint in_view = (column < camera.width) & (row < camera.height);
      const Rays rays = make_rays(column, row, camera, T_W_D, grid);
      surfaces[k] = find_beside(rays, first_rays, surfaces[0], in_view, origin, offsets, voxels, grid);
      append(&missing, column, row, in_view & surfaces[0].known & NOT(surfaces[k].known));
    }
    for (int k = 0; k < PATCH_RAYS; k += RAY_STRIDE) {
      store_surfaces(surfaces[k], surfaces[k + 1], patch_x, y + k / RAY_STRIDE, depth, normals, camera,
                     T_W_D);
    }
  }
  cast_listed(&missing, all_bins, origin, offsets, voxels, nearest, depth, normals, camera, T_W_D, grid,
              range);
}
