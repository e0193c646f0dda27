// Fusion of a frame's measurements into the visible blocks. A work-item takes VOXELS_PER_ITEM voxels;
// neighbouring items take neighbouring ones.
//   voxels        distances and certainties of the pool
//   visible       slots to update
//   block_states  BLOCK_* bits a slot, 0 before
//   measurements  a word a pixel, see types.h
//   normals       read by DISTANCE_REFINED only
#include "shared/block_items.h"
#include "shared/image.h"
#include "tsdf_fusion/block_projection.h"
#include "tsdf_fusion/filter_rules.h"
#include "tsdf_fusion/measured_distance.h"

#define SLICE_VOXELS (ITEM_VOXELS == 1 ? 1 : BLOCK_SIZE * BLOCK_SIZE)
#define SLICE_VECTORS (SLICE_VOXELS / SIMD_WIDTH)

// Rounds up or down at random, so that the mean stays; truncation of a positive number rounds down.
inline vint dithered(vfloat value, vfloat random) { return TO_VINT(value + (random + 512.0f)) - 512; }

inline vuchar magnitude(vchar value) {
  return AS_VUCHAR(select(value, (vchar)(-value), (vchar)(value < (vchar)(0))));
}

#define HALF_BLOCK_LOG2 (BLOCK_SIZE_LOG2 - 1)

// The bits of BLOCK_NEAR_SURFACE of a vector of voxels.
inline vint octant_bits(int first_voxel) {
  const vint voxel = first_voxel + LANE_INDICES;
  const vint octant = (voxel >> HALF_BLOCK_LOG2 & 1) | (voxel >> (BLOCK_SIZE_LOG2 + HALF_BLOCK_LOG2) & 1) << 1 |
                      (voxel >> (2 * BLOCK_SIZE_LOG2 + HALF_BLOCK_LOG2) & 1) << 2;
  return (vint)(1) << (octant + BLOCK_NEAR_SURFACE_SHIFT);
}

inline int any_bits(vint bits) {
  int lanes[SIMD_WIDTH];
  VSTORE(bits, lanes);
  for (int i = 1; i < SIMD_WIDTH; ++i) lanes[0] |= lanes[i];
  return lanes[0];
}

__kernel void integrate_blocks(__global char *voxels, __global const int *visible, int visible_count,
                               __global const int4 *block_indices, __global int *block_states,
                               __global const uint *measurements, __global const uint *normals,
                               CameraArgs camera, TransformArgs T_D_W, GridArgs grid, SensorArgs sensor,
                               FusionArgs args) {
  const int item = get_global_id(0);
  const int entry = item / ITEMS_PER_BLOCK;
  if (entry >= visible_count) return;
  const int first_voxel = item % ITEMS_PER_BLOCK * ITEM_VOXELS;
  const int slot = visible[entry];
  const int3 block = block_indices[slot].xyz;
  const float block_m = grid.voxel_size_m * BLOCK_SIZE;
  __global char *distances = voxels + block_distances(slot);
  __global uchar *certainties = (__global uchar *)voxels + block_certainties(slot);
  const float steps_per_m = TSDF_MAX / grid.truncation_m;
  const float free_steps_per_m = args.free_space_sigmas * steps_per_m;
  const BlockProjection projection = block_projection(block, T_D_W, camera, grid.voxel_size_m);
  const uint phase_of_first = dither_phase(0, block, args.frame);

  // All the rays through a block are taken to be as steep as the one through its middle.
  const float3 middle = transform_point(T_D_W, (convert_float3(block) + 0.5f) * block_m);
  const float ray_length = length(middle) / fmax(middle.z, grid.voxel_size_m);
  const vuchar near_steps = (vuchar)(min(1.7320508f * grid.voxel_size_m * steps_per_m, (float)TSDF_MAX));
  vint state = 0;

  for (int slice = first_voxel; slice < first_voxel + ITEM_VOXELS; slice += SLICE_VOXELS) {
    // A slice's pixels are read before any is used, so that a CPU need not wait for one after the other.
    vuint words[SLICE_VECTORS];
    for (int i = 0; i < SLICE_VECTORS; ++i) {
      words[i] = GATHER(vuint, measurements, voxel_pixels(projection, slice + i * SIMD_WIDTH, camera));
    }
    for (int i = 0; i < SLICE_VECTORS; ++i) {
      const int voxel = slice + i * SIMD_WIDTH;
      const Measurement measured = unpack_measurement(words[i], args.depth_step_m);
      const MeasuredDistance surface =
          measured_distance(voxel_points(projection, voxel, camera), measured, ray_length, measurements, normals,
                            camera, grid.truncation_m, args.depth_step_m);
      const vfloat steps = surface.distance_m * steps_per_m;

      vchar distance = ALIGNED(vchar, distances + voxel);
      const vint known = TO_VINT(distance) != TSDF_CHI;
      const vint seen = (words[i] != 0) & (steps >= -TSDF_MAX);
      const vint hit = seen & (steps <= TSDF_MAX);
      if (ANY(hit | (seen & known))) {
        const vuchar old_byte = ALIGNED(vuchar, certainties + voxel);
        const vfloat old_steps = TO_VFLOAT(distance);
        const vfloat axial_m = AXIAL_SIGMA_M(sensor, measured.depth_m) * surface.slope;
        const vint beyond = (steps - TSDF_MAX) * measured.accuracy > free_steps_per_m * axial_m;
        const vint freed = seen & beyond & known;
        const vuint phase = phase_of_first + DITHER_STEP * (AS_VUINT(LANE_INDICES) + (uint)voxel);
        const vfloat random = TO_VFLOAT(AS_VINT(phase >> 8)) * (1.0f / 16777216.0f);
        const FilterStep step = fuse_measurement(TO_VINT(old_byte), known, args.units_per_m2 * axial_m * axial_m,
                                                 measured.accuracy * measured.accuracy, args);
        const vfloat base_steps = select(steps, old_steps, known);
        const vint fused = clamp(dithered(base_steps + step.gain * (steps - base_steps), random),
                                 (vint)(-TSDF_MAX), (vint)(TSDF_MAX));
        const vint byte = clamp(dithered(step.certainty, 1.0f - random), (vint)(1), (vint)(CERTAINTY_MAX));
        distance = select(distance, TO_VCHAR(fused), TO_VMASK8(hit));
        vuchar new_byte = select(old_byte, TO_VUCHAR(byte), TO_VMASK8(hit));
        if (ANY(freed)) {
          const vint doubted = max(dithered(doubt(TO_VINT(old_byte), args), 1.0f - random), (vint)(0));
          distance = select(distance, (vchar)(TSDF_CHI), TO_VMASK8(freed & (doubted < args.min_certainty)));
          new_byte = select(new_byte, TO_VUCHAR(doubted), TO_VMASK8(freed));
        }
        ALIGNED(vchar, distances + voxel) = distance;
        ALIGNED(vuchar, certainties + voxel) = new_byte;
      }
      state |= select((vint)(0), (vint)(BLOCK_HAS_DATA), TO_VINT(distance != (vchar)(TSDF_CHI)));
      state |= select((vint)(0), octant_bits(voxel), TO_VINT(magnitude(distance) <= near_steps));
    }
  }

  const int bits = any_bits(state);
  if ((block_states[slot] & bits) != bits) atomic_or(block_states + slot, bits);
}
