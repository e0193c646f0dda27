// The rules of fusion. FUSION_RULE: FUSION_AVERAGE, FUSION_WEIGHTED or FUSION_KALMAN (see types.h).
// fuse_measurement() is what a measurement makes of a voxel, doubt() what is left of its certainty where the space is seen
// to be free.
//   certainty  a voxel's second byte, or the exact number before it is rounded to one
#include "shared/simd.h"
#include "shared/types.h"
#ifndef FUSION_RULE
#define FUSION_RULE FUSION_KALMAN
#endif

typedef struct {
  vfloat gain;  // how far the distance goes to the measured one, in (0, 1]
  vfloat certainty;
} FilterStep;

// Weights below would let the bytes that hold their sums count few of many measurements.
#define MIN_WEIGHT 0.25f

#if FUSION_RULE == FUSION_AVERAGE

inline FilterStep fuse_measurement(vfloat certainty, vint known, vfloat variance_m2, const FusionArgs args) {
  FilterStep step;
  step.gain = select((vfloat)(1.0f), min(args.gain_at_1m * args.variance_at_1m_m2 / variance_m2, 1.0f), known);
  step.certainty = select((vfloat)(1.0f), certainty + 1.0f, known);
  return step;
}

inline vfloat doubt(vfloat certainty, const FusionArgs args) { return certainty * (1.0f - args.free_space_rate); }

#elif FUSION_RULE == FUSION_WEIGHTED

inline FilterStep fuse_measurement(vfloat certainty, vint known, vfloat variance_m2, const FusionArgs args) {
  const vfloat weight = max(args.weight_at_1m * args.variance_at_1m_m2 / variance_m2, MIN_WEIGHT);
  const vfloat total = weight + select((vfloat)(0.0f), certainty, known);
  FilterStep step;
  step.gain = weight / total;
  step.certainty = min(total, args.max_weight);
  return step;
}

inline vfloat doubt(vfloat certainty, const FusionArgs args) { return certainty * (1.0f - args.free_space_rate); }

#else

inline vfloat variance_of(vfloat certainty) {
  return AS_VFLOAT(VARIANCE_BITS_MAX - (TO_VINT(certainty) - 1) * VARIANCE_BITS_STEP);
}

inline vfloat certainty_of(vfloat variance_m2) {
  return TO_VFLOAT(VARIANCE_BITS_MAX - AS_VINT(variance_m2)) * (1.0f / VARIANCE_BITS_STEP) + 1.0f;
}

inline FilterStep fuse_measurement(vfloat certainty, vint known, vfloat variance_m2, const FusionArgs args) {
  const vfloat predicted_m2 = variance_of(certainty) + args.process_variance_m2;
  FilterStep step;
  step.gain = select((vfloat)(1.0f), predicted_m2 / (predicted_m2 + variance_m2), known);
  step.certainty = certainty_of(step.gain * variance_m2);
  return step;
}

inline vfloat doubt(vfloat certainty, const FusionArgs args) {
  return certainty_of(variance_of(certainty) / (1.0f - args.free_space_rate));
}

#endif
