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

// Phase of a voxel's dither: spread by a hash over the blocks, by the golden ratio along a block's voxels and over the
// frames, so that the rounding errors of one voxel cancel over the frames faster than independent draws would.
inline uint dither_phase(int voxel, int3 block, int frame) {
  uint hash = (uint)(block.x * 73856093 ^ block.y * 19349669 ^ block.z * 83492791);
  hash = (hash ^ (hash >> 15)) * 0x85ebca6bu;
  return hash + (uint)(voxel + frame) * 0x9e3779b9u;
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
  __global char *distances = voxels + block_distances(slot);
  __global uchar *weights = (__global uchar *)voxels + block_weights(slot);
  const float steps_per_m = TSDF_MAX / grid.truncation_m;

  // Offsets of a vector's voxels from its first; a vector is a row of a block, or several.
  const vfloat lane_i = TO_VFLOAT(LANE_INDICES & (BLOCK_SIZE - 1)) * size;
  const vfloat lane_j = TO_VFLOAT(LANE_INDICES >> BLOCK_SIZE_LOG2) * size;
  const vfloat lane_x = T_D_W.rotation[0] * lane_i + T_D_W.rotation[1] * lane_j;
  const vfloat lane_y = T_D_W.rotation[3] * lane_i + T_D_W.rotation[4] * lane_j;
  const vfloat lane_z = T_D_W.rotation[6] * lane_i + T_D_W.rotation[7] * lane_j;
  const vuint lane_phase = AS_VUINT(LANE_INDICES) * 0x9e3779b9u;

  // Distances are measured along the rays, all through a block with the slope of the ray through its middle.
  const float3 middle = transform_point(T_D_W, (convert_float3(block) + 0.5f) * (size * BLOCK_SIZE));
  const float ray_steps_per_m = steps_per_m * length(middle) / fmax(middle.z, size);
  vuchar smallest = 128;

  for (int voxel = first_voxel; voxel < first_voxel + ITEM_VOXELS; voxel += SIMD_WIDTH) {
    const int3 in_block = (int3)(voxel & (BLOCK_SIZE - 1), (voxel >> BLOCK_SIZE_LOG2) & (BLOCK_SIZE - 1),
                                 voxel >> (2 * BLOCK_SIZE_LOG2));
    const float3 first = transform_point(T_D_W, convert_float3(block * BLOCK_SIZE + in_block) * size);
    const vfloat z = first.z + lane_z;
    const vfloat per_z = 1.0f / z;
    const vfloat u = camera.fx * (first.x + lane_x) * per_z + (camera.cx + 0.5f);
    const vfloat v = camera.fy * (first.y + lane_y) * per_z + (camera.cy + 0.5f);
    vint updated = (z > 0.0f) & (u >= 0.0f) & (u < camera.width) & (v >= 0.0f) & (v < camera.height);
    const vint pixel = select((vint)(0), pixel_indices(TO_VINT(u), TO_VINT(v), camera), updated);
    const vfloat measured = GATHER(vfloat, depth, pixel);
    const vfloat measured_steps = min((measured - z) * ray_steps_per_m, 2.0f * TSDF_MAX);
    updated = updated & (measured > 0.0f) & (measured_steps >= -TSDF_MAX);

    vchar distance = VLOAD(distances + voxel);
    if (ANY(updated)) {
      const vuchar old_weight = VLOAD(weights + voxel);
      const vfloat old_steps = TO_VFLOAT(distance);
      const vint known = old_steps != TSDF_CHI;
      const vfloat weight = select((vfloat)(0.0f), TO_VFLOAT(old_weight), known);
      const vfloat measured_weight = clamp(args.weight_at_1m * per_z * per_z, args.min_weight,
                                           args.max_measurement_weight);
      const vfloat total = weight + measured_weight;
      const vfloat base_steps = select(measured_steps, old_steps, known);
      const vfloat steps = base_steps + measured_weight / total * (measured_steps - base_steps);
      const vuint phase = dither_phase(voxel, block, args.frame) + lane_phase;
      const vfloat random = TO_VFLOAT(AS_VINT(phase >> 8)) * (1.0f / 16777216.0f);
      // truncation of a positive number rounds down
      const vint rounded = max(TO_VINT(steps + (random + 512.0f)) - 512, (vint)(-TSDF_MAX));
      const vint fused = select(rounded, (vint)(TSDF_CHI), rounded > TSDF_MAX);
      const vint new_weight = TO_VINT(min(total + (1.0f - random), args.max_weight));
      distance = select(distance, TO_VCHAR(fused), TO_VMASK8(updated));
      VSTORE(distance, distances + voxel);
      VSTORE(select(old_weight, TO_VUCHAR(new_weight), TO_VMASK8(updated)), weights + voxel);
    }
    smallest = min(smallest, abs(distance));
  }

  uchar lanes[SIMD_WIDTH];
  VSTORE(smallest, lanes);
  for (int i = 1; i < SIMD_WIDTH; ++i) lanes[0] = min(lanes[0], lanes[i]);
  const int state = (lanes[0] <= TSDF_MAX ? BLOCK_HAS_DATA : 0) |
                    (lanes[0] <= 1.7320508f * size * steps_per_m ? BLOCK_NEAR_SURFACE : 0);
  if ((block_states[slot] & state) != state) atomic_or(block_states + slot, state);
}
