// Weighted fusion (Algorithm 2 of the paper) of a depth image into the visible blocks. A work-item takes one voxel of a
// block on a GPU, one slice of a block in vectors on a CPU; neighbouring items take neighbouring voxels.
//   voxels        distances and weights of the pool
//   visible       slots to update
//   block_states  BLOCK_* bits a slot, 0 before
#include "shared/block_map.h"
#include "shared/image.h"

#if SIMD_WIDTH == 1
#define ITEM_VOXELS 1
#else
#define ITEM_VOXELS (BLOCK_SIZE * BLOCK_SIZE)
#endif
#define ITEMS_PER_BLOCK (BLOCK_VOXELS / ITEM_VOXELS)

// Uniform in [0, 1): a hash of the voxel, advanced by the golden ratio each frame, so that the rounding errors of one
// voxel cancel over the frames faster than independent draws would.
inline vfloat dither(vint voxel, int3 block, int frame) {
  vuint h = AS_VUINT(voxel) + (uint)(block.x * 73856093 ^ block.y * 19349669 ^ block.z * 83492791);
  h = (h ^ (h >> 15)) * 0x85ebca6bu;
  h = (h ^ (h >> 13)) * 0xc2b2ae35u;
  h = (h ^ (h >> 16)) + (uint)frame * 0x9e3779b9u;
  return TO_VFLOAT(AS_VINT(h >> 8)) * (1.0f / 16777216.0f);
}

__kernel void integrate_blocks(__global char *voxels, __global const int *visible, int visible_count,
                               __global const int4 *block_indices, __global int *block_states,
                               __global const float *depth, CameraArgs camera, TransformArgs T_D_W, GridArgs grid,
                               FusionArgs args) {
  const int item = get_global_id(0);
  const int entry = item / ITEMS_PER_BLOCK;
  if (entry >= visible_count) return;
  const int first_voxel = item % ITEMS_PER_BLOCK * ITEM_VOXELS;
  const int slot = visible[entry];
  const int3 block = block_indices[slot].xyz;
  const float size = grid.voxel_size_m;
  const float3 origin_D = transform_point(T_D_W, convert_float3(block * BLOCK_SIZE) * size);
  __global char *distances = voxels + block_distances(slot);
  __global uchar *weights = (__global uchar *)voxels + block_weights(slot);
  const float steps_per_m = TSDF_MAX / grid.truncation_m;
  const float near_surface = 1.7320508f * size * steps_per_m;
  int state = 0;

  for (int voxel = first_voxel; voxel < first_voxel + ITEM_VOXELS; voxel += SIMD_WIDTH) {
    const vint index = voxel + LANE_INDICES;
    const vfloat i = TO_VFLOAT(index & (BLOCK_SIZE - 1)) * size;
    const vfloat j = TO_VFLOAT((index >> BLOCK_SIZE_LOG2) & (BLOCK_SIZE - 1)) * size;
    const vfloat k = TO_VFLOAT(index >> (2 * BLOCK_SIZE_LOG2)) * size;
    const vfloat x = origin_D.x + rotated(T_D_W, 0, i, j, k);
    const vfloat y = origin_D.y + rotated(T_D_W, 1, i, j, k);
    const vfloat z = origin_D.z + rotated(T_D_W, 2, i, j, k);
    const vfloat per_z = 1.0f / z;
    const vint u = TO_VINT(floor(camera.fx * x * per_z + (camera.cx + 0.5f)));
    const vint v = TO_VINT(floor(camera.fy * y * per_z + (camera.cy + 0.5f)));
    vint updated = (z > 0.0f) & (u >= 0) & (u < camera.width) & (v >= 0) & (v < camera.height);

    const vint old_distance = TO_VINT(VLOAD(distances + voxel));
    vint new_distance = old_distance;
    if (ANY(updated)) {
      const vint pixel = select((vint)(IMAGE_GUARD), pixel_indices(u, v, camera), updated);
      const vfloat measured = GATHER(vfloat, depth, pixel);
      // distance along the ray, the paper's simplest estimate of T_k
      const vfloat distance_m = (measured - z) * sqrt((x * x + y * y) * per_z * per_z + 1.0f);
      updated = updated & (measured > 0.0f) & (distance_m >= -grid.truncation_m);
      if (ANY(updated)) {
        const vint known = old_distance != TSDF_CHI;
        const vfloat weight = TO_VFLOAT(VLOAD(weights + voxel));
        const vfloat measured_weight =
            clamp(args.weight_at_1m / (measured * measured), args.min_weight, args.max_measurement_weight);
        const vfloat measured_steps = min(distance_m * steps_per_m, 2.0f * TSDF_MAX);
        const vfloat old_steps = TO_VFLOAT(old_distance);
        const vfloat gain = measured_weight / (weight + measured_weight);
        const vfloat steps = select(measured_steps, old_steps + gain * (measured_steps - old_steps), known);
        const vfloat total = select(measured_weight, weight + measured_weight, known);
        const vfloat random = dither(index, block, args.frame);
        const vint rounded = TO_VINT(floor(steps + random));
        const vint clamped = select(max(rounded, (vint)(-TSDF_MAX)), (vint)(TSDF_CHI), rounded > TSDF_MAX);
        new_distance = select(old_distance, clamped, updated);
        const vuchar new_weight = TO_VUCHAR(min(floor(total + 1.0f - random), args.max_weight));
        VSTORE(TO_VCHAR(new_distance), distances + voxel);
        VSTORE(select(VLOAD(weights + voxel), new_weight, TO_VMASK8(updated)), weights + voxel);
      }
    }
    const vint has_data = new_distance != TSDF_CHI;
    if (ANY(has_data)) {
      state |= BLOCK_HAS_DATA;
      const vint near = has_data & (fabs(TO_VFLOAT(new_distance)) <= near_surface);
      if (ANY(near)) state |= BLOCK_NEAR_SURFACE;
    }
  }
  if ((block_states[slot] & state) != state) atomic_or(block_states + slot, state);
}
