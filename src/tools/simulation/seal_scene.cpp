// A carved seal that lies along x in empty space: handle with beads, bosses, flutes and rings of a
// millimetre, and a flat, printed face of a coin's size. Seen head-on, the face hides the handle, and
// geometry leaves three directions free.
#include <cmath>

#include "depth_fusion/geometry/angles.h"
#include "tools/simulation/scenes.h"

namespace depth_fusion {
namespace {

using Eigen::Vector3d;
using Solids = std::vector<Primitive>;

constexpr double kGoldenAngle_rad = 2.399963229728653;

const Material kHorn{{120, 160, 185}, Pattern::kMottle, 0.004, 0.35};
const Material kBrass{{80, 150, 180}, Pattern::kMottle, 0.003, 0.35};
const Material kPrint{{140, 150, 155}, Pattern::kMottle, 0.006, 0.6};

// The point at `bearing_rad` about the handle's axis.
Vector3d aroundAxis(double x_m, double radius_m, double bearing_rad) {
  return {x_m, radius_m * std::cos(bearing_rad), radius_m * std::sin(bearing_rad)};
}

// Makes a knob of 44 mm with beads spread evenly over it, a few tenths of a millimetre to a millimetre high.
void addKnob(Solids& solids) {
  constexpr int kBeads = 170;
  const double radius_m = 0.022;
  const Vector3d centre_W(-0.047, 0, 0);
  solids.push_back(sphere(centre_W, radius_m, kHorn));
  for (int i = 0; i < kBeads; ++i) {
    const double along = 1.0 - (2.0 * i + 1.0) / kBeads;
    const Vector3d out = aroundAxis(along, std::sqrt(1.0 - along * along), i * kGoldenAngle_rad);
    const double bead_m = 0.0010 + 0.0002 * (i * 7 % 6);
    solids.push_back(sphere(centre_W + (radius_m - 0.6 * bead_m) * out, bead_m, kBrass));
  }
}

// Makes a fluted shaft with two bands of bosses.
void addShaft(Solids& solids) {
  const double radius_m = 0.016;
  solids.push_back(cylinder({-0.04, 0, 0}, {0.03, 0, 0}, radius_m, kHorn));
  for (int i = 0; i < 26; ++i) {
    const double bearing_rad = (i + 0.15 * (i * 5 % 7)) * kRadPerDeg * 360.0 / 26;
    const double from_m = -0.012 + 0.0006 * (i * 3 % 5), to_m = 0.012 - 0.0006 * (i * 4 % 7);
    solids.push_back(capsule(aroundAxis(from_m, radius_m, bearing_rad),
                             aroundAxis(to_m, radius_m, bearing_rad), 0.0004 + 0.0001 * (i % 5), kHorn));
  }
  for (int i = 0; i < 28; ++i) {
    const double x_m = i % 2 == 0 ? 0.017 : 0.023;
    solids.push_back(sphere(aroundAxis(x_m, radius_m, i * kRadPerDeg * 360.0 / 28),
                            0.0009 + 0.0002 * (i * 3 % 4), kBrass));
  }
}

void addNeck(Solids& solids) {
  solids.push_back(cylinder({0.02, 0, 0}, {0.072, 0, 0}, 0.011, kHorn));
  for (const double x_m : {0.034, 0.0375, 0.0405, 0.052, 0.0545, 0.064}) {
    solids.push_back(torus({x_m, 0, 0}, {1, 0, 0}, 0.011, 0.0006 + 0.02 * (0.066 - x_m), kBrass));
  }
  for (int i = 0; i < 14; ++i) {
    solids.push_back(sphere(aroundAxis(0.0465 + 0.0008 * (i * 5 % 3), 0.0108, i * kRadPerDeg * 360.0 / 14),
                            0.0012, kBrass));
  }
}

// Makes the face, 34 mm wide, at x = 75 mm.
void addFace(Solids& solids) { solids.push_back(cylinder({0.07, 0, 0}, {0.075, 0, 0}, 0.017, kPrint)); }

// The camera goes around the seal's middle in 12 s at 0.2 to 0.25 m, above one side and below the other,
// slowly where it looks at the face head-on.
Gaze sealGaze(const Sway& walk, const Sway& look) {
  const double phase_rad = (30.0 * walk.time_s() - 100.0) * kRadPerDeg;
  const double bearing_rad = phase_rad - 0.9 * std::sin(phase_rad);
  const double pitch_rad = 45.0 * kRadPerDeg * std::sin(bearing_rad);
  const double range_m = 0.245 + 0.004 * walk(0, 3.0);
  const Vector3d towards_eye(std::cos(bearing_rad) * std::cos(pitch_rad),
                             std::sin(bearing_rad) * std::cos(pitch_rad), std::sin(pitch_rad));
  Gaze gaze;
  gaze.target_W = {0.048 * std::cos(bearing_rad), 0.003 * look(1, 2.3), 0.003 * look(2, 2.9)};
  gaze.eye_W = gaze.target_W + range_m * towards_eye;
  gaze.roll_rad = 6.0 * look(3, 3.1) * kRadPerDeg;
  return gaze;
}

}  // namespace

SimulatedScene makeSealScene() {
  Solids solids;
  addKnob(solids);
  addShaft(solids);
  addNeck(solids);
  addFace(solids);
  return {Scene(std::move(solids)), partScanner(), sealGaze};
}

}  // namespace depth_fusion
