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

// Rounds up or down at random, so that the mean stays; truncation of a positive number rounds down.
inline vint dithered(vfloat value, vfloat random) { return TO_VINT(value + (random + 512.0f)) - 512; }

inline vuchar magnitude(vchar value) {
  return AS_VUCHAR(select(value, (vchar)(-value), (vchar)(value < (vchar)(0))));
}

// A surface that is so many standard deviations farther or nearer than a voxel may still be where the voxel
// is.
#define NOISY_SIGMAS 2.0f

// OCTANT says which octant of its block a voxel lies in.
#define HALF_BLOCK_LOG2 (BLOCK_SIZE_LOG2 - 1)
#define OCTANT(voxel)                                                                             \
  (((voxel) >> HALF_BLOCK_LOG2 & 1) | ((voxel) >> (BLOCK_SIZE_LOG2 + HALF_BLOCK_LOG2) & 1) << 1 | \
   ((voxel) >> (2 * BLOCK_SIZE_LOG2 + HALF_BLOCK_LOG2) & 1) << 2)
#define LANE_OCTANT_BITS TO_VUCHAR((vint)(1) << OCTANT(LANE_INDICES))

inline int any_bits(vuchar bits) {
  uchar lanes[SIMD_WIDTH];
  VSTORE(bits, lanes);
  for (int i = 1; i < SIMD_WIDTH; ++i) lanes[0] |= lanes[i];
  return lanes[0];
}

// Asks for the distances that a work-item will read.
inline void prefetch_distances(int item, __global const char* voxels, __global const int* visible,
                               int visible_count) {
  if (item / ITEMS_PER_BLOCK >= visible_count) return;
  __global const char* distances =
      voxels + block_distances(visible[item / ITEMS_PER_BLOCK]) + item % ITEMS_PER_BLOCK * ITEM_VOXELS;
  for (int i = 0; i < ITEM_VOXELS; i += CACHE_LINE) PREFETCH(distances + i);
}

__kernel void integrate_blocks(__global char* voxels, __global const int* visible, int visible_count,
                               __global const int4* block_indices, __global int* block_states,
                               __global const uint* measurements, __global const uint* normals,
                               CameraArgs camera, TransformArgs T_D_W, GridArgs grid, SensorArgs sensor,
                               FusionArgs args) {
  const int item = get_global_id(0);
  const int entry = item / ITEMS_PER_BLOCK;
  if (entry >= visible_count) return;
  const int first_voxel = item % ITEMS_PER_BLOCK * ITEM_VOXELS;
  const int slot = visible[entry];
  const int3 block = block_indices[slot].xyz;
  const float block_m = grid.voxel_size_m * BLOCK_SIZE;
  __global char* distances = voxels + block_distances(slot);
  __global uchar* certainties = (__global uchar*)voxels + block_certainties(slot);
  const float steps_per_m = TSDF_MAX / grid.truncation_m;
  const float free_steps_per_m = args.free_space_sigmas * steps_per_m;
  const float noisy_steps_per_m = NOISY_SIGMAS * steps_per_m;
  prefetch_distances(item + 1, voxels, visible, visible_count);
  const BlockProjection projection = block_projection(block, T_D_W, camera, grid.voxel_size_m);
  const uint phase_of_first = dither_phase(0, block, args.frame);

  // All the rays through a block are taken to be as steep as the one through its middle.
  const float3 middle = transform_point(T_D_W, (convert_float3(block) + 0.5f) * block_m);
  const float ray_length = length(middle) / fmax(middle.z, grid.voxel_size_m);
  const vuchar near_steps = (vuchar)(min(1.7320508f * grid.voxel_size_m * steps_per_m, (float)TSDF_MAX));
  vuchar data = 0, octants = 0, sure = 0;

  for (int part = first_voxel; part < first_voxel + ITEM_VOXELS; part += PART_VOXELS) {
    // All of a part's pixels are found before any is read, so that a CPU need not wait for one after the
    // other.
    const Points from_first_part = from_first_voxel(&projection, part);
    vint pixels[PART_VECTORS];
    for (int i = 0; i < PART_VECTORS; ++i) {
      pixels[i] = pixels_of(sum_of(projection.first_part[i], from_first_part), camera);
    }
    for (int i = 0; i < PART_VECTORS; ++i) {
      const int voxel = part + i * SIMD_WIDTH;
      const vuint word = gather_from_memory(measurements, (const int*)(pixels + i));
      const Measurement measured = unpack_measurement(word, args.depth_step_m);
      const Points points = unscaled(sum_of(projection.first_part[i], from_first_part), camera);
      const MeasuredDistance surface = measured_distance(points, measured, ray_length, measurements, normals,
                                                         camera, grid.truncation_m, args.depth_step_m);
      const vfloat steps = surface.distance_m * steps_per_m;

      vchar distance = ALIGNED(vchar, distances + voxel);
      const vint known = TO_VINT(distance) != TSDF_CHI;
      const vint seen = word != 0;
      const vint near = seen & (fabs(steps) <= TSDF_MAX);
      if (ANY(near | (seen & known))) {
        const vuchar old_byte = ALIGNED(vuchar, certainties + voxel);
        const vfloat old_steps = TO_VFLOAT(distance);
        const vfloat axial_m = AXIAL_SIGMA_M(sensor, measured.depth_m) * surface.slope;
        const vint beyond = (steps - TSDF_MAX) * measured.accuracy > free_steps_per_m * axial_m;
        const vint freed = seen & beyond & known;
        const vint noisy = fabs(steps) * measured.accuracy <= noisy_steps_per_m * axial_m;
        const vint hit = near | (seen & noisy & known & ~freed);
        const vuint phase =
            DITHER_STEP * AS_VUINT(LANE_INDICES) + (phase_of_first + DITHER_STEP * (uint)voxel);
        const vfloat random = TO_VFLOAT(AS_VINT(phase >> 8)) * (1.0f / 16777216.0f);
        const FilterStep step =
            fuse_measurement(TO_VINT(old_byte), known, args.units_per_m2 * axial_m * axial_m,
                             measured.accuracy * measured.accuracy, args);
        const vfloat bounded = clamp(steps, (vfloat)(-TSDF_MAX), (vfloat)(TSDF_MAX));
        const vfloat base_steps = select(bounded, old_steps, known);
        const vint fused = clamp(dithered(base_steps + step.gain * (bounded - base_steps), random),
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
        sure |= select((vuchar)(0), (vuchar)(1), TO_VMASK8(TO_VINT(new_byte) >= args.min_certainty));
      }
      const vuchar octant_bits = LANE_OCTANT_BITS << (uchar)OCTANT(voxel);
      data |= AS_VUCHAR(distance) ^ (uchar)(TSDF_CHI);
      octants |= select((vuchar)(0), octant_bits, TO_VMASK8(magnitude(distance) <= near_steps));
    }
  }

  const int bits = (any_bits(data) != 0 ? BLOCK_HAS_DATA : 0) |
                   any_bits(octants) << BLOCK_NEAR_SURFACE_SHIFT | (any_bits(sure) != 0 ? BLOCK_SURE : 0);
  if ((block_states[slot] & bits) != bits) atomic_or(block_states + slot, bits);
}
