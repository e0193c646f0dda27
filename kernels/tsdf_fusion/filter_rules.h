// The rules of fusion. FUSION_RULE: FUSION_AVERAGE, FUSION_WEIGHTED or FUSION_KALMAN (see types.h).
// fuse_measurement() says what a measurement makes of a voxel, doubt() what is left of its certainty where
// the space is seen to be free.
//   certainty  a voxel's second byte, or the exact number before it is rounded to one
//   axial      a measurement's variance if it were as accurate as can be, in units (see types.h);
//              the variance itself is axial / squared_accuracy
#include "shared/simd.h"
#include "shared/types.h"
#ifndef FUSION_RULE
#define FUSION_RULE FUSION_KALMAN
#endif

typedef struct {
  vfloat gain;  // how far the distance goes to the measured one, in (0, 1]; any number where the voxel is not
                // known
  vfloat certainty;
} FilterStep;

#if FUSION_RULE == FUSION_AVERAGE

inline FilterStep fuse_measurement(vint certainty, vint known, vfloat axial, vfloat squared_accuracy,
                                   const FusionArgs args) {
  FilterStep step;
  step.gain = min(args.gain_at_1m * args.variance_at_1m * squared_accuracy / axial, 1.0f);
  step.certainty = TO_VFLOAT(select((vint)(0), certainty, known)) + 1.0f;
  return step;
}

inline vfloat doubt(vint certainty, const FusionArgs args) {
  return TO_VFLOAT(certainty) * args.free_space_kept;
}

#elif FUSION_RULE == FUSION_WEIGHTED

// Weights below this one are raised to it: of many such measurements, the bytes that hold the sums would
// count few.
#define MIN_WEIGHT 0.25f

inline FilterStep fuse_measurement(vint certainty, vint known, vfloat axial, vfloat squared_accuracy,
                                   const FusionArgs args) {
  const vfloat weight = max(args.weight_at_1m * args.variance_at_1m * squared_accuracy / axial, MIN_WEIGHT);
  const vfloat total = weight + TO_VFLOAT(select((vint)(0), certainty, known));
  FilterStep step;
  step.gain = weight / total;
  step.certainty = min(total, args.max_weight);
  return step;
}

inline vfloat doubt(vint certainty, const FusionArgs args) {
  return TO_VFLOAT(certainty) * args.free_space_kept;
}

#elif FUSION_RULE == FUSION_KALMAN

// Bits of the variance of a voxel that is not known: 1, so large that the measurement's takes its place.
#define UNKNOWN_VARIANCE_BITS 0x3f800000

inline vint variance_bits(vint certainty) { return VARIANCE_BITS_MAX - (certainty - 1) * VARIANCE_BITS_STEP; }

inline vfloat certainty_of(vfloat variance) {
  return TO_VFLOAT(VARIANCE_BITS_MAX - AS_VINT(variance)) * (1.0f / VARIANCE_BITS_STEP) + 1.0f;
}

inline FilterStep fuse_measurement(vint certainty, vint known, vfloat axial, vfloat squared_accuracy,
                                   const FusionArgs args) {
  const vint bits = select((vint)(UNKNOWN_VARIANCE_BITS), variance_bits(certainty), known);
  const vfloat predicted = AS_VFLOAT(bits) + args.process_variance;
  const vfloat accurate = predicted * squared_accuracy;
  const vfloat per_sum = 1.0f / (accurate + axial);
  FilterStep step;
  step.gain = accurate * per_sum;
  step.certainty = certainty_of(predicted * axial * per_sum);
  return step;
}

inline vfloat doubt(vint certainty, const FusionArgs args) {
  return certainty_of(AS_VFLOAT(variance_bits(certainty)) / args.free_space_kept);
}

#else
#error "there is no such FUSION_RULE"
#endif
