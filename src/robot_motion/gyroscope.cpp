#include "depth_fusion/robot_motion/gyroscope.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace depth_fusion {
namespace {

constexpr double kRatesKept_s = 2.0;
constexpr double kMissing_s = 0.1;
constexpr double kBias_rad_s = 0.02;        // of a sensor that is not known yet
constexpr double kBiasWalk_rad2_s3 = 1e-9;  // by which it changes, a variance a second
constexpr double kTracked_rad = 0.003;      // standard deviation of a rotation that tracking finds
constexpr double kUnknown_m = 2.0;          // of the translation
constexpr double kSurprise = 5.0;           // a rotation farther off, in standard deviations, tells no bias

Eigen::Matrix3d turned(const Eigen::Vector3d& rotation) {
  const double angle = rotation.norm();
  if (!(angle > 0.0)) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, rotation / angle).toRotationMatrix();
}

}  // namespace

Gyroscope::Gyroscope() : bias_variance_(kBias_rad_s * kBias_rad_s) {}

void Gyroscope::add(const ImuReading& reading) {
  if (!reading.angular_velocity_D || !reading.angular_velocity_D->allFinite()) return;
  if (!rates_.empty()) {
    const double seconds = reading.stamp_s - rates_.back().stamp_s;
    if (seconds <= 0.0 && seconds > -kRatesKept_s) return;
    if (seconds < 0.0) {
      rates_.clear();
      before_s_.reset();
    }
  }
  rates_.push_back({reading.stamp_s, *reading.angular_velocity_D});
  while (rates_.front().stamp_s < reading.stamp_s - kRatesKept_s) rates_.pop_front();
}

std::optional<FrameMotion> Gyroscope::motionTo(double stamp_s, const RobotMotionParameters& parameters) {
  const std::optional<double> from_s = std::exchange(before_s_, stamp_s);
  interval_s_ = 0.0;
  const std::optional<Eigen::Matrix3d> found =
      from_s && *from_s < stamp_s ? rotation(*from_s, stamp_s) : std::nullopt;
  if (!found) return std::nullopt;
  last_ = *found;
  interval_s_ = stamp_s - *from_s;
  bias_variance_ = std::min(bias_variance_ + kBiasWalk_rad2_s3 * interval_s_, kBias_rad_s * kBias_rad_s);
  FrameMotion motion{"gyroscope"};
  motion.T_previous_current.linear() = last_;
  const double rate = std::sqrt(bias_variance_) + parameters.gyroscope_noise_rad_s;
  motion.covariance.diagonal().head<3>().setConstant(std::pow(rate * interval_s_, 2) + 1e-8);
  motion.covariance.diagonal().tail<3>().setConstant(kUnknown_m * kUnknown_m);
  return motion;
}

void Gyroscope::learn(const Eigen::Matrix3d& R_previous_current, const RobotMotionParameters& parameters) {
  if (interval_s_ <= 0.0) return;
  const Eigen::AngleAxisd error(Eigen::Matrix3d(R_previous_current.transpose() * last_));
  const Eigen::Vector3d rate = error.angle() * error.axis() / interval_s_;
  const double noise =
      std::pow(kTracked_rad / interval_s_, 2) + std::pow(parameters.gyroscope_noise_rad_s, 2);
  if (rate.squaredNorm() > kSurprise * kSurprise * (noise + bias_variance_)) return;
  const double gain = bias_variance_ / (bias_variance_ + noise);
  bias_rad_s_ += gain * rate;
  bias_variance_ *= 1.0 - gain;
}

std::optional<Eigen::Matrix3d> Gyroscope::rotation(double from_s, double to_s) const {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  double missing_s = 0.0, done_s = from_s;
  for (const Rate& rate : rates_) {
    if (rate.stamp_s <= from_s) continue;
    const double until_s = std::min(rate.stamp_s, to_s), seconds = until_s - done_s;
    missing_s += std::max(seconds - kMissing_s / 2.0, 0.0);
    rotation = rotation * turned((rate.rad_s - bias_rad_s_) * seconds);
    done_s = until_s;
    if (done_s >= to_s) break;
  }
  if (missing_s > 0.0 || to_s - done_s > kMissing_s || rates_.empty()) return std::nullopt;
  return rotation * turned((rates_.back().rad_s - bias_rad_s_) * (to_s - done_s));
}

}  // namespace depth_fusion
