#include "depth_fusion/robot_motion/gravity.h"

#include <algorithm>
#include <cmath>

namespace depth_fusion {
namespace {

constexpr double kGravity_m_s2 = 9.81, kOff_m_s2 = 1.5;
constexpr double kMemory_s = 1.0, kMemoryWithoutGyroscope_s = 0.2;
constexpr double kGap_s = 0.5;  // after which the direction is another one
constexpr int kFew = 3;

}  // namespace

void Gravity::add(const ImuReading& reading, const Eigen::Vector3d& gyroscope_bias_rad_s) {
  const double seconds = last_s_ ? reading.stamp_s - *last_s_ : 0.0;
  if (last_s_ && seconds <= 0.0 && seconds > -kGap_s) return;
  last_s_ = reading.stamp_s;
  if (seconds < 0.0 || seconds > kGap_s) readings_ = 0;
  if (reading.angular_velocity_D && readings_ > 0) {
    // The sensor turns, and what stands still turns the other way in it.
    const Eigen::Vector3d turn = -seconds * (*reading.angular_velocity_D - gyroscope_bias_rad_s);
    if (turn.norm() > 0.0) force_D_ = Eigen::AngleAxisd(turn.norm(), turn.normalized()) * force_D_;
  }
  if (!reading.specific_force_D) return;
  if (!(std::abs(reading.specific_force_D->norm() - kGravity_m_s2) < kOff_m_s2)) return;
  const double memory_s = reading.angular_velocity_D ? kMemory_s : kMemoryWithoutGyroscope_s;
  const double share =
      readings_ == 0 ? 1.0 : std::max(1.0 / (readings_ + 1), std::min(seconds / memory_s, 1.0));
  force_D_ += share * (*reading.specific_force_D - force_D_);
  ++readings_;
}

std::optional<Eigen::Vector3d> Gravity::up_D() const {
  if (readings_ < kFew || !(force_D_.norm() > 0.0)) return std::nullopt;
  return force_D_.normalized();
}

}  // namespace depth_fusion
