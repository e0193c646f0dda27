#include "depth_fusion/recording/trajectory_file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "common/io/text_file.h"
#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

bool earlierPose(const StampedPose& a, const StampedPose& b) { return a.stamp_s < b.stamp_s; }

constexpr size_t kNumbers = 8;

// Gives nothing for what trackers write where they have no pose: numbers that are not finite, a quaternion of
// zeros.
std::optional<StampedPose> poseOf(const std::vector<double>& v) {
  constexpr double kLeastNorm = 1e-6;
  const Eigen::Quaterniond rotation(v[7], v[4], v[5], v[6]);
  const bool is_finite = std::all_of(v.begin(), v.end(), [](double number) { return std::isfinite(number); });
  if (!is_finite || rotation.norm() < kLeastNorm) return std::nullopt;
  StampedPose pose;
  pose.stamp_s = stampSeconds(v[0]);
  pose.T_W_D.linear() = rotation.normalized().toRotationMatrix();
  pose.T_W_D.translation() << v[1], v[2], v[3];
  return pose;
}

std::string poseText(const StampedPose& pose) {
  const Eigen::Vector3d p_W = pose.T_W_D.translation();
  const Eigen::Quaterniond q(pose.T_W_D.linear());
  char text[512];
  std::snprintf(text, sizeof(text), " %.9f %.9f %.9f %.9f %.9f %.9f %.9f\n", p_W.x(), p_W.y(), p_W.z(), q.x(),
                q.y(), q.z(), q.w());
  return stampText(pose.stamp_s) + text;
}

}  // namespace

Trajectory readTrajectory(const std::string& path, std::string* remark) {
  Trajectory trajectory;
  LeftOut left_out;
  for (const TextLine& line : readTextLines(path)) {
    const auto numbers = parseNumbers(withDecimalPoints(line.text));
    if (!numbers || numbers->size() != kNumbers) {
      left_out.add(line.where + ": '" + line.text + "' is not a pose; expected 'stamp tx ty tz qx qy qz qw'");
    } else if (const auto pose = poseOf(*numbers)) {
      trajectory.push_back(*pose);
    }
  }
  const bool is_forgiven = left_out.empty() || (remark != nullptr && !trajectory.empty());
  check(is_forgiven, left_out.firstProblem());
  if (!left_out.empty()) *remark += left_out.text("line");
  check(!trajectory.empty(), path + ": holds no pose; expected lines 'stamp tx ty tz qx qy qz qw'");
  std::stable_sort(trajectory.begin(), trajectory.end(), earlierPose);
  return trajectory;
}

void writeTrajectory(const std::string& path, const Trajectory& trajectory) {
  std::string text = "# timestamp tx ty tz qx qy qz qw\n";
  for (const StampedPose& pose : trajectory) text += poseText(pose);
  writeText(path, text);
}

std::optional<Pose> poseAt(const Trajectory& trajectory, double stamp_s, double max_gap_s) {
  StampedPose wanted;
  wanted.stamp_s = stamp_s;
  const auto after = std::lower_bound(trajectory.begin(), trajectory.end(), wanted, earlierPose);
  if (after == trajectory.end()) return std::nullopt;
  if (after->stamp_s == stamp_s) return after->T_W_D;
  if (after == trajectory.begin()) return std::nullopt;
  const auto before = std::prev(after);
  if (after->stamp_s - stamp_s > max_gap_s || stamp_s - before->stamp_s > max_gap_s) return std::nullopt;
  return interpolate(*before, *after, stamp_s);
}

}  // namespace depth_fusion
