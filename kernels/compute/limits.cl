// What the device can do at most, for benchmarks to compare kernels with: an empty launch, copying,
// arithmetic, gathers. A work-item takes SIMD_WIDTH elements at a time.
#include "shared/simd.h"

__kernel void do_nothing(__global float* unused) {}

// Both buffers hold SIMD_WIDTH elements a work-item.
__kernel void copy_memory(__global const float* source, __global float* destination) {
  const size_t first = get_global_id(0) * SIMD_WIDTH;
  VSTORE(VLOAD(source + first), destination + first);
}

// Does 8 multiply-adds a round and lane, in chains that do not wait for each other.
__kernel void multiply_add(__global float* sums, int rounds, float factor) {
  const vfloat start = TO_VFLOAT(LANE_INDICES);
  vfloat a = start, b = start + 1, c = start + 2, d = start + 3, e = start + 4, f = start + 5, g = start + 6,
         h = start + 7;
  for (int round = 0; round < rounds; ++round) {
    a = mad(a, (vfloat)(factor), start);
    b = mad(b, (vfloat)(factor), start);
    c = mad(c, (vfloat)(factor), start);
    d = mad(d, (vfloat)(factor), start);
    e = mad(e, (vfloat)(factor), start);
    f = mad(f, (vfloat)(factor), start);
    g = mad(g, (vfloat)(factor), start);
    h = mad(h, (vfloat)(factor), start);
  }
  VSTORE(a + b + c + d + e + f + g + h, sums + get_global_id(0) * SIMD_WIDTH);
}

// Gathers one word a round and lane, from anywhere in a table whose size is a power of two.
__kernel void gather_words(__global const int* table, __global int* sums, int rounds, int last_index) {
  const int first = get_global_id(0) * SIMD_WIDTH;
  vuint place = (AS_VUINT(LANE_INDICES) + (uint)first) * 2654435769u;
  vint sum = 0;
  for (int round = 0; round < rounds; ++round) {
    place = place * 1664525u + 1013904223u;
    sum += GATHER(vint, table, AS_VINT(place >> 8) & last_index);
  }
  VSTORE(sum, sums + first);
}
