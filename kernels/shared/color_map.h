// Colours in the block-sparse map: blue, green, red and weight a voxel, from the lowest byte on. Weight 0 =
// no colour.
#include "shared/block_map.h"

inline float4 unpack_color(uint packed) {
  return convert_float4((uint4)(packed, packed >> 8, packed >> 16, packed >> 24) & 255u);
}

inline float4 color_of_voxel(int3 voxel, __global const int* offsets, __global const uint* colors,
                             const GridArgs grid) {
  const int address = block_address(voxel >> BLOCK_SIZE_LOG2, grid);
  const int slot = address < 0 ? BLOCK_EMPTY : offsets[address];
  if (slot < 0) return 0.0f;
  return unpack_color(colors[block_colors(slot) + voxel_number(voxel & (BLOCK_SIZE - 1))]);
}

// Returns the colour at a point given in voxels: the mean of those of the eight voxels around it that have
// one, in which nearer and surer voxels weigh more. Component w is 0 if none has a colour.
inline float4 sample_color(float3 p_vox, __global const int* offsets, __global const uint* colors,
                           const GridArgs grid) {
  const float3 lowest = floor(p_vox);
  const float3 fraction = p_vox - lowest;
  float4 sum = 0.0f;
  for (int i = 0; i < 8; ++i) {
    const int3 corner = (int3)(i & 1, (i >> 1) & 1, i >> 2);
    const float4 color = color_of_voxel(convert_int3(lowest) + corner, offsets, colors, grid);
    const float3 share = select(1.0f - fraction, fraction, corner != 0);
    const float weight = color.w * (share.x * share.y * share.z);
    sum += (float4)(weight * color.xyz, weight);
  }
  const float least_weight = 1e-3f;
  return sum.w > least_weight ? (float4)(sum.xyz / sum.w, sum.w) : (float4)(0.0f);
}

// Returns the same and, where those eight have no colour, the mean of the voxels up to NEARBY_VOX away, for
// pictures and meshes.
#define NEARBY_VOX 2
inline float4 sample_color_nearby(float3 p_vox, __global const int* offsets, __global const uint* colors,
                                  const GridArgs grid) {
  const float4 own = sample_color(p_vox, offsets, colors, grid);
  if (own.w > 0.0f) return own;
  const int3 middle = convert_int3_rte(p_vox);
  float4 sum = 0.0f;
  for (int k = -NEARBY_VOX; k <= NEARBY_VOX; ++k) {
    for (int j = -NEARBY_VOX; j <= NEARBY_VOX; ++j) {
      for (int i = -NEARBY_VOX; i <= NEARBY_VOX; ++i) {
        const float4 color = color_of_voxel(middle + (int3)(i, j, k), offsets, colors, grid);
        const float weight = color.w / (1 + i * i + j * j + k * k);
        sum += (float4)(weight * color.xyz, weight);
      }
    }
  }
  return sum.w > 0.0f ? (float4)(sum.xyz / sum.w, sum.w) : (float4)(0.0f);
}
