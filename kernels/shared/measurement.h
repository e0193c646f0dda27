// Measurements: what fusion needs to know of a pixel, packed in a word (see types.h).
#include "shared/simd.h"
#include "shared/types.h"

typedef struct {
  vfloat depth_m;   // 0 = no measurement
  vfloat cosine;    // of the angle between ray and surface normal; 1 where the normal is not known
  vfloat accuracy;  // the axial sigma over the sigma, in (0, 1]
} Measurement;

inline vuint to_code(vfloat fraction) {
  return AS_VUINT(TO_VINT(clamp(fraction * MEASUREMENT_MAX + 0.5f, 1.0f, (float)MEASUREMENT_MAX)));
}

inline vuint pack_measurement(Measurement m, float depth_step_m) {
  const vuint depth = AS_VUINT(TO_VINT(min(m.depth_m / depth_step_m + 0.5f, (float)MEASUREMENT_DEPTH_MAX)));
  return depth << (2 * MEASUREMENT_BITS) | to_code(m.cosine) << MEASUREMENT_BITS | to_code(m.accuracy);
}

inline Measurement unpack_measurement(vuint word, float depth_step_m) {
  const float per_code = 1.0f / MEASUREMENT_MAX;
  Measurement m;
  m.depth_m = TO_VFLOAT(AS_VINT(word >> (2 * MEASUREMENT_BITS))) * depth_step_m;
  m.cosine = TO_VFLOAT(AS_VINT(word >> MEASUREMENT_BITS & MEASUREMENT_MAX)) * per_code;
  m.accuracy = TO_VFLOAT(AS_VINT(word & MEASUREMENT_MAX)) * per_code;
  return m;
}
