// Start-up self-test: sum of squares with vectors and an atomic. A work-item takes SIMD_WIDTH values.
//   values  count * SIMD_WIDTH integers
//   sum     one integer, 0 before
#include "shared/simd.h"

__kernel void sum_of_squares(__global const int* values, __global int* sum, int count) {
  const int item = get_global_id(0);
  if (item >= count) return;
  const vint index = item * SIMD_WIDTH + LANE_INDICES;
  const vfloat value = TO_VFLOAT(GATHER(vint, values, index));
  atomic_add(sum, convert_int(SUM_LANES(value * value)));
}
