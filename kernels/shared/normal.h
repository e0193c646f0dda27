// Unit normals, packed in a word (see types.h). They face the camera, so z is well below 1.
#include "shared/simd.h"
#include "shared/types.h"

// Packs the vectors' directions.
inline vuint pack_normals(vfloat x, vfloat y, vfloat z) {
  const vfloat steps = NORMAL_STEPS / max(sqrt(x * x + y * y + z * z) - z, (vfloat)(1e-20f));
  const vuint u = AS_VUINT(TO_VINT(clamp(x * steps + (NORMAL_ZERO + 0.5f), 1.0f, NORMAL_MAX)));
  const vuint v = AS_VUINT(TO_VINT(clamp(y * steps + (NORMAL_ZERO + 0.5f), 1.0f, NORMAL_MAX)));
  return u | v << 16;
}

typedef struct {
  vfloat x, y, z;
} Normals;

inline Normals unpack_normals(vuint word) {
  const vfloat u = (TO_VFLOAT(AS_VINT(word & 0xffffu)) - NORMAL_ZERO) * (1.0f / NORMAL_STEPS);
  const vfloat v = (TO_VFLOAT(AS_VINT(word >> 16)) - NORMAL_ZERO) * (1.0f / NORMAL_STEPS);
  const vfloat scale = 2.0f / (1.0f + u * u + v * v);
  const Normals normals = {u * scale, v * scale, 1.0f - scale};
  return normals;
}

inline uint pack_normal(float3 n) {
  return FIRST_LANE(pack_normals((vfloat)(n.x), (vfloat)(n.y), (vfloat)(n.z)));
}

inline float3 unpack_normal(uint word) {
  const Normals n = unpack_normals((vuint)(word));
  return (float3)(FIRST_LANE(n.x), FIRST_LANE(n.y), FIRST_LANE(n.z));
}
