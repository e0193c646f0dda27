#include "tools/simulation/camera_path.h"

#include <cmath>
#include <cstdint>

namespace depth_fusion {
namespace {

using Eigen::Vector3d;

constexpr double kFullTurn_rad = 6.283185307179586;
constexpr int kTremorChannel = 100;
constexpr double kTremorPeriod_s = 0.3;
constexpr double kTremor_m = 0.001;
constexpr double kTremor_rad = 0.002;

double phase(unsigned seed, int index) {
  uint64_t hash = (static_cast<uint64_t>(seed) << 32 | static_cast<uint32_t>(index)) + 0x9e3779b97f4a7c15ull;
  hash = (hash ^ (hash >> 30)) * 0xbf58476d1ce4e5b9ull;
  hash = (hash ^ (hash >> 27)) * 0x94d049bb133111ebull;
  return kFullTurn_rad * static_cast<double>((hash ^ (hash >> 31)) >> 11) / 9007199254740992.0;
}

// The camera has x right, y down and z forward, with the world's z up.
Pose lookAt(const Gaze& gaze) {
  const Vector3d forward = (gaze.target_W - gaze.eye_W).normalized();
  const Vector3d right = forward.cross(Vector3d::UnitZ()).normalized();
  Pose T_W_D = Pose::Identity();
  T_W_D.linear() << right, forward.cross(right), forward;
  T_W_D.rotate(Eigen::AngleAxisd(gaze.roll_rad, Vector3d::UnitZ()));
  T_W_D.translation() = gaze.eye_W;
  return T_W_D;
}

}  // namespace

double Sway::operator()(int channel, double period_s) const {
  const double angle = kFullTurn_rad * time_s_ / period_s;
  return 0.75 * std::sin(angle + phase(seed_, 2 * channel)) +
         0.25 * std::sin(1.618 * angle + phase(seed_, 2 * channel + 1));
}

Pose handHeldPose(const GazePath& path, unsigned seed, const HandSpeed& speed, double time_s, double tremor) {
  const Sway sway(seed, time_s);
  Vector6d twist;
  for (int i = 0; i < 6; ++i) {
    twist[i] = tremor * (i < 3 ? kTremor_rad : kTremor_m) *
               sway(kTremorChannel + i, kTremorPeriod_s * (1.0 + 0.2 * i));
  }
  return lookAt(path(Sway(seed, speed.walk * time_s), Sway(seed, speed.look * time_s))) *
         poseFromTwist(twist);
}

Rates ratesAt(const GazePath& path, unsigned seed, double time_s) {
  constexpr double kStep_s = 0.001;
  const auto poseAt = [&](double at_s) { return lookAt(path(Sway(seed, at_s), Sway(seed, at_s))); };
  const Pose motion = poseAt(time_s).inverse() * poseAt(time_s + kStep_s);
  return {motion.translation().norm() / kStep_s, rotationAngle(motion) / kStep_s};
}

}  // namespace depth_fusion
