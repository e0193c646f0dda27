// Fusion of a frame's measurements into the visible blocks. A work-item takes one voxel of a block on a GPU, one slice of
// a block in vectors on a CPU; neighbouring items take neighbouring voxels.
//   voxels        distances and certainties of the pool
//   visible       slots to update
//   block_states  BLOCK_* bits a slot, 0 before
//   measurements  a word a pixel, see types.h
//   normals       three planes of `plane` elements, read by DISTANCE_REFINED only
#include "shared/block_items.h"
#include "shared/image.h"
#include "tsdf_fusion/filter_rules.h"
#include "tsdf_fusion/measured_distance.h"

// Rounds up or down at random, so that the mean stays; truncation of a positive number rounds down.
inline vint dithered(vfloat value, vfloat random) { return TO_VINT(value + (random + 512.0f)) - 512; }

__kernel void integrate_blocks(__global char *voxels, __global const int *visible, int visible_count,
                               __global const int4 *block_indices, __global int *block_states,
                               __global const uint *measurements, __global const float *normals, int plane,
                               CameraArgs camera, TransformArgs T_D_W, GridArgs grid, SensorArgs sensor,
                               FusionArgs args) {
  const int item = get_global_id(0);
  const int entry = item / ITEMS_PER_BLOCK;
  if (entry >= visible_count) return;
  const int first_voxel = item % ITEMS_PER_BLOCK * ITEM_VOXELS;
  const int slot = visible[entry];
  const int3 block = block_indices[slot].xyz;
  const float size = grid.voxel_size_m;
  __global char *distances = voxels + block_distances(slot);
  __global uchar *certainties = (__global uchar *)voxels + block_certainties(slot);
  const float steps_per_m = TSDF_MAX / grid.truncation_m;
  const float free_steps_per_m = args.free_space_sigmas * steps_per_m;

  // Offsets of a vector's voxels from its first; a vector is a row of a block, or several.
  const vfloat lane_i = TO_VFLOAT(LANE_INDICES & (BLOCK_SIZE - 1)) * size;
  const vfloat lane_j = TO_VFLOAT(LANE_INDICES >> BLOCK_SIZE_LOG2) * size;
  const vfloat lane_x = T_D_W.rotation[0] * lane_i + T_D_W.rotation[1] * lane_j;
  const vfloat lane_y = T_D_W.rotation[3] * lane_i + T_D_W.rotation[4] * lane_j;
  const vfloat lane_z = T_D_W.rotation[6] * lane_i + T_D_W.rotation[7] * lane_j;
  const vuint lane_phase = AS_VUINT(LANE_INDICES) * 0x9e3779b9u;

  // All the rays through a block are taken to be as steep as the one through its middle.
  const float3 middle = transform_point(T_D_W, (convert_float3(block) + 0.5f) * (size * BLOCK_SIZE));
  const float ray_length = length(middle) / fmax(middle.z, size);
  vuchar smallest = 128;

  for (int voxel = first_voxel; voxel < first_voxel + ITEM_VOXELS; voxel += SIMD_WIDTH) {
    const int3 in_block = (int3)(voxel & (BLOCK_SIZE - 1), (voxel >> BLOCK_SIZE_LOG2) & (BLOCK_SIZE - 1),
                                 voxel >> (2 * BLOCK_SIZE_LOG2));
    const float3 first = transform_point(T_D_W, convert_float3(block * BLOCK_SIZE + in_block) * size);
    Points points = {first.x + lane_x, first.y + lane_y, first.z + lane_z};
    const vfloat per_z = 1.0f / points.z;
    const vfloat u = camera.fx * points.x * per_z + (camera.cx + 0.5f);
    const vfloat v = camera.fy * points.y * per_z + (camera.cy + 0.5f);
    const vint in_view = (points.z > 0.0f) & (u >= 0.0f) & (u < camera.width) & (v >= 0.0f) & (v < camera.height);
    const vint pixel = select((vint)(0), pixel_indices(TO_VINT(u), TO_VINT(v), camera), in_view);
    const Measurement measured = unpack_measurement(GATHER(vuint, measurements, pixel), args.depth_step_m);
    const MeasuredDistance surface =
        measured_distance(points, measured, ray_length, measurements, normals, plane, camera, grid.truncation_m,
                          args.depth_step_m);
    const vfloat axial_m = AXIAL_SIGMA_M(sensor, measured.depth_m) * surface.slope;
    const vfloat steps = surface.distance_m * steps_per_m;

    vchar distance = VLOAD(distances + voxel);
    const vfloat old_steps = TO_VFLOAT(distance);
    const vint known = old_steps != TSDF_CHI;
    const vint seen = (measured.depth_m > 0.0f) & (steps >= -TSDF_MAX);
    const vint beyond = (steps - TSDF_MAX) * measured.accuracy > free_steps_per_m * axial_m;
    const vint hit = seen & (steps <= TSDF_MAX);
    const vint freed = seen & beyond & known;
    if (ANY(hit | freed)) {
      const vuchar old_byte = VLOAD(certainties + voxel);
      const vuint phase = dither_phase(voxel, block, args.frame) + lane_phase;
      const vfloat random = TO_VFLOAT(AS_VINT(phase >> 8)) * (1.0f / 16777216.0f);
      const FilterStep step = fuse_measurement(TO_VINT(old_byte), known, axial_m * axial_m,
                                               measured.accuracy * measured.accuracy, args);
      const vfloat base_steps = select(steps, old_steps, known);
      const vint fused = clamp(dithered(base_steps + step.gain * (steps - base_steps), random), (vint)(-TSDF_MAX),
                               (vint)(TSDF_MAX));
      const vint byte = clamp(dithered(step.certainty, 1.0f - random), (vint)(1), (vint)(CERTAINTY_MAX));
      distance = select(distance, TO_VCHAR(fused), TO_VMASK8(hit));
      vuchar new_byte = select(old_byte, TO_VUCHAR(byte), TO_VMASK8(hit));
      if (ANY(freed)) {
        const vint doubted = max(dithered(doubt(TO_VINT(old_byte), args), 1.0f - random), (vint)(0));
        distance = select(distance, (vchar)(TSDF_CHI), TO_VMASK8(freed & (doubted < args.min_certainty)));
        new_byte = select(new_byte, TO_VUCHAR(doubted), TO_VMASK8(freed));
      }
      VSTORE(distance, distances + voxel);
      VSTORE(new_byte, certainties + voxel);
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
