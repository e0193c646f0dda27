#include "depth_fusion/robot_motion/odometry_watch.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>
#include <vector>

#include "depth_fusion/geometry/angles.h"

namespace depth_fusion {
namespace {

constexpr double kRemembered_s = 10.0, kCompared_s = 1.0;
constexpr double kSigmas = 4.0, kLeastError_m = 0.03, kLeastError_rad = 0.03;
constexpr int kDoubt = 45, kMostDoubt = 90;  // comparisons, one a frame
constexpr int kDoubtOfOne = 3;               // that contradicts, where one that agrees takes one away
constexpr double kExplained = 0.3;           // what is left of the differences where their cause is found
constexpr double kMostOffset_s = 0.4, kOffsetStep_s = 0.005, kLeastOffset_s = 0.015;
constexpr double kLeastTurn_rad = 0.05;

using Motions = std::deque<ComparedMotion>;

// The motion over the last second, as both have it.
ComparedMotion together(const Motions& motions) {
  ComparedMotion sum{motions.back().stamp_s};
  for (auto motion = motions.rbegin(); motion != motions.rend() && sum.interval_s < kCompared_s; ++motion) {
    sum.by_camera = motion->by_camera * sum.by_camera;
    sum.by_odometry = motion->by_odometry * sum.by_odometry;
    sum.interval_s += motion->interval_s;
  }
  return sum;
}

bool contradicts(const ComparedMotion& motion, const RobotMotionParameters& parameters) {
  const Pose error = motion.by_camera.inverse() * motion.by_odometry;
  const double way_m =
      std::max(motion.by_camera.translation().norm(), motion.by_odometry.translation().norm());
  const double angle_rad = std::max(rotationAngle(motion.by_camera), rotationAngle(motion.by_odometry));
  return error.translation().norm() > kLeastError_m + kSigmas * parameters.odometry_distance_sigma * way_m ||
         rotationAngle(error) > kLeastError_rad + kSigmas * parameters.odometry_angle_sigma * angle_rad;
}

// Speed and turn rate of one of the two, each in the middle of its interval.
struct Rates {
  std::vector<double> times_s;
  std::vector<Eigen::Vector2d> rates;

  // In proportion between the two nearest; none before the first and after the last.
  std::optional<Eigen::Vector2d> at(double time_s) const {
    const auto next = std::lower_bound(times_s.begin(), times_s.end(), time_s);
    if (next == times_s.begin() || next == times_s.end()) return std::nullopt;
    const size_t i = static_cast<size_t>(next - times_s.begin());
    const double part = (time_s - times_s[i - 1]) / (times_s[i] - times_s[i - 1]);
    return Eigen::Vector2d((1.0 - part) * rates[i - 1] + part * rates[i]);
  }
};

Rates ratesOf(const Motions& motions, Pose ComparedMotion::*source) {
  Rates rates;
  for (const ComparedMotion& motion : motions) {
    rates.times_s.push_back(motion.stamp_s - motion.interval_s / 2.0);
    rates.rates.push_back(
        Eigen::Vector2d((motion.*source).translation().norm(), rotationAngle(motion.*source)) /
        motion.interval_s);
  }
  return rates;
}

// The mean squared difference of the rates if odometry's stamps are so much too late.
double differenceAt(const Rates& camera, const Rates& odometry, double late_s) {
  double sum = 0.0;
  int count = 0;
  for (size_t i = 0; i < camera.times_s.size(); ++i) {
    const double time_s = camera.times_s[i];
    if (time_s < camera.times_s.front() + kMostOffset_s || time_s > camera.times_s.back() - kMostOffset_s)
      continue;
    const std::optional<Eigen::Vector2d> rates = odometry.at(time_s + late_s);
    if (!rates) continue;
    sum += (*rates - camera.rates[i]).squaredNorm();
    ++count;
  }
  return count > 0 ? sum / count : 0.0;
}

std::string offsetOf(const Motions& motions) {
  const Rates camera = ratesOf(motions, &ComparedMotion::by_camera);
  const Rates odometry = ratesOf(motions, &ComparedMotion::by_odometry);
  const double as_it_is = differenceAt(camera, odometry, 0.0);
  std::pair<double, double> best{as_it_is, 0.0};
  for (double late_s = -kMostOffset_s; late_s <= kMostOffset_s; late_s += kOffsetStep_s)
    best = std::min(best, {differenceAt(camera, odometry, late_s), late_s});
  if (std::abs(best.second) < kLeastOffset_s || best.first > kExplained * as_it_is) return "";
  char text[160];
  std::snprintf(text, sizeof(text), "its stamps are about %.0f ms too %s; correct them by %+.0f ms",
                1e3 * std::abs(best.second), best.second > 0.0 ? "late" : "early", -1e3 * best.second);
  return text;
}

// Rotations and translations of both, by twos: where the camera stands turned on the robot, one set is the
// other turned.
std::string turnOf(const Motions& motions) {
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> pairs;
  for (const ComparedMotion& motion : motions) {
    const Vector6d camera = twistFromPose(motion.by_camera), odometry = twistFromPose(motion.by_odometry);
    pairs.emplace_back(camera.head<3>(), odometry.head<3>());
    pairs.emplace_back(camera.tail<3>(), odometry.tail<3>());
  }
  for (const auto& [camera, odometry] : pairs) products += camera * odometry.transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(products, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d mirror = Eigen::Matrix3d::Identity();
  mirror(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  const Eigen::Matrix3d turn = svd.matrixU() * mirror * svd.matrixV().transpose();
  double as_it_is = 0.0, turned = 0.0;
  for (const auto& [camera, odometry] : pairs) {
    as_it_is += (camera - odometry).squaredNorm();
    turned += (camera - turn * odometry).squaredNorm();
  }
  const Eigen::AngleAxisd axis(turn);
  if (axis.angle() < kLeastTurn_rad || turned > kExplained * as_it_is) return "";
  const Eigen::Vector3d deg = kDegPerRad * axis.angle() * axis.axis();
  char text[240];
  std::snprintf(
      text, sizeof(text),
      "the camera stands turned by %.1f degrees from where tf has it: about its own axes x %+.1f, y "
      "%+.1f, z %+.1f degrees",
      kDegPerRad * axis.angle(), -deg.x(), -deg.y(), -deg.z());
  return text;
}

}  // namespace

void OdometryWatch::add(const ComparedMotion& motion, const RobotMotionParameters& parameters) {
  motions_.push_back(motion);
  while (motions_.front().stamp_s < motion.stamp_s - kRemembered_s) motions_.pop_front();
  const ComparedMotion sum = together(motions_);
  if (sum.interval_s < kCompared_s) return;
  in_doubt_ = std::clamp(in_doubt_ + (contradicts(sum, parameters) ? kDoubtOfOne : -1), 0, kMostDoubt);
  if (in_doubt_ == 0) problem_.clear();
  if (in_doubt_ < kDoubt || (!problem_.empty() && in_doubt_ < kMostDoubt)) return;
  char text[200];
  std::snprintf(text, sizeof(text),
                "odometry contradicts the camera: over the last second it says %.2f m and %.1f degrees, the "
                "camera %.2f m and %.1f degrees; ",
                sum.by_odometry.translation().norm(), kDegPerRad * rotationAngle(sum.by_odometry),
                sum.by_camera.translation().norm(), kDegPerRad * rotationAngle(sum.by_camera));
  problem_ = text + cause();
}

std::string OdometryWatch::cause() const {
  const std::string offset = offsetOf(motions_);
  if (!offset.empty()) return offset;
  const std::string turn = turnOf(motions_);
  return turn.empty() ? "do the wheels slip, or is the calibration of the odometry wrong?" : turn;
}

}  // namespace depth_fusion
