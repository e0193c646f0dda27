// Procedural textures, made of hashed lattice values.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "tools/simulation/primitive.h"

namespace depth_fusion {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

// A lattice cell's coordinates are multiplied by these and joined.
constexpr uint32_t kFactors[3] = {73856093u, 19349663u, 83492791u};

// Returns a value in [-1, 1] for joined coordinates (PCG hash).
double hashed(uint32_t joined) {
  uint32_t hash = joined * 747796405u + 2891336453u;
  hash = ((hash >> ((hash >> 28) + 4)) ^ hash) * 277803737u;
  hash ^= hash >> 22;
  return hash * (2.0 / 4294967295.0) - 1.0;
}

double cellValue(const Vector3i& cell) {
  uint32_t joined = 0;
  for (int axis = 0; axis < 3; ++axis) joined ^= static_cast<uint32_t>(cell[axis]) * kFactors[axis];
  return hashed(joined);
}

int floored(double value) {
  const int truncated = static_cast<int>(value);
  return truncated - (value < truncated ? 1 : 0);
}

Vector3i cellOf(const Vector3d& p) { return {floored(p.x()), floored(p.y()), floored(p.z())}; }

// Joins lattice values smoothly (trilinear with eased fractions).
double smoothNoise(const Vector3d& p) {
  uint32_t factor[3][2];
  double weight[3][2];
  for (int axis = 0; axis < 3; ++axis) {
    const int cell = floored(p[axis]);
    const double fraction = p[axis] - cell;
    const double ease = fraction * fraction * (3.0 - 2.0 * fraction);
    weight[axis][0] = 1.0 - ease;
    weight[axis][1] = ease;
    factor[axis][0] = static_cast<uint32_t>(cell) * kFactors[axis];
    factor[axis][1] = factor[axis][0] + kFactors[axis];
  }
  double value = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const int x = corner & 1, y = (corner >> 1) & 1, z = corner >> 2;
    value += weight[0][x] * weight[1][y] * weight[2][z] * hashed(factor[0][x] ^ factor[1][y] ^ factor[2][z]);
  }
  return value;
}

double speckles(const Vector3d& p) {
  return 0.9 * smoothNoise(p) + 0.6 * smoothNoise(2.3 * p) + 0.5 * smoothNoise(5.1 * p);
}

double tiles(const Vector3d& p) { return 0.6 * cellValue(cellOf(p)) + 0.4 * cellValue(cellOf(3.0 * p)); }

double repeated(const Vector3d& p) { return tiles(4.0 * (p - cellOf(p).cast<double>())); }

double wood(const Vector3d& p) {
  const Vector3d along_grain(0.15 * p.x(), p.y(), p.z());
  return 0.7 * std::sin(9.0 * smoothNoise(along_grain)) + 0.4 * smoothNoise(6.0 * p);
}

// Makes spots of every size; each octave has steep sides and is turned against the last. The finer ones are
// stronger, so that small patches differ as much as large ones.
double mottle(Vector3d p) {
  static const Eigen::Matrix3d kTurn =
      Eigen::AngleAxisd(0.7, Vector3d(1.0, 2.0, 3.0).normalized()).toRotationMatrix();
  constexpr double kSteepness = 4.0;
  double value = 0.0, amplitude = 0.3;
  for (int octave = 0; octave < 5; ++octave) {
    p = kTurn * p + Vector3d::Constant(17.3);
    value += amplitude * std::clamp(kSteepness * smoothNoise(p), -1.0, 1.0);
    p *= 2.03;
    amplitude *= 1.1;
  }
  return value;
}

// Returns the pattern's brightness about 0, mostly within [-1, 1].
double brightness(Pattern pattern, const Vector3d& p) {
  switch (pattern) {
    case Pattern::kPlain:
      return 0.0;
    case Pattern::kSpeckles:
      return speckles(p);
    case Pattern::kTiles:
      return tiles(p);
    case Pattern::kWood:
      return wood(p);
    case Pattern::kRepeated:
      return repeated(p);
    case Pattern::kMottle:
      return mottle(p);
  }
  return 0.0;
}

}  // namespace

Vector3d textureColor(const Material& material, const Vector3d& p_W) {
  // The offset keeps lattice planes off the round coordinates at which surfaces lie.
  const Vector3d p = p_W / material.scale_m + Vector3d(0.371, 0.593, 0.417);
  const double gain = 1.0 + material.contrast * brightness(material.pattern, p);
  return (gain * material.color_bgr).cwiseMax(0.0).cwiseMin(255.0);
}

}  // namespace depth_fusion
