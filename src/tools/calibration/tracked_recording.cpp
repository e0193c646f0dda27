#include "tools/calibration/tracked_recording.h"

#include <algorithm>

#include "depth_fusion/common/error.h"
#include "depth_fusion/pipeline/reconstruction_pipeline.h"

namespace depth_fusion {
namespace {

constexpr size_t kMaxFrames = 100;
constexpr double kFirstStep = 0.02;  // metres, and radians, from one frame to the next
constexpr double kMaxGap_s = 0.25;

// Keeps frames a step apart; the step grows so that they do not become too many.
class FrameChoice {
 public:
  void offer(const RgbdFrame& frame, const Pose& T_W_D) {
    if (!frames_.empty() && distance(frames_.back().T_W_D, T_W_D) < step_) return;
    frames_.push_back({frame, T_W_D, Vector6d::Zero()});
    frames_.back().frame.color.release();
    if (frames_.size() > kMaxFrames) thinOut();
  }

  std::vector<CalibrationFrame> take() { return std::move(frames_); }

 private:
  static double distance(const Pose& a, const Pose& b) {
    const Pose motion = a.inverse() * b;
    return motion.translation().norm() + rotationAngle(motion);
  }

  void thinOut() {
    step_ *= 1.5;
    std::vector<CalibrationFrame> kept;
    for (CalibrationFrame& frame : frames_) {
      if (kept.empty() || distance(kept.back().T_W_D, frame.T_W_D) >= step_) kept.push_back(std::move(frame));
    }
    frames_ = std::move(kept);
  }

  double step_ = kFirstStep;
  std::vector<CalibrationFrame> frames_;
};

// The velocity between the poses before and after; zero at the ends.
Vector6d velocityAt(const Trajectory& trajectory, double stamp_s) {
  const auto now =
      std::lower_bound(trajectory.begin(), trajectory.end(), stamp_s,
                       [](const StampedPose& pose, double stamp) { return pose.stamp_s < stamp; });
  if (now == trajectory.begin() || now + 1 == trajectory.end()) return Vector6d::Zero();
  const StampedPose &before = *(now - 1), &after = *(now + 1);
  if (after.stamp_s - before.stamp_s > kMaxGap_s) return Vector6d::Zero();
  return twistFromPose(before.T_W_D.inverse() * after.T_W_D) / (after.stamp_s - before.stamp_s);
}

class ColorMotions {
 public:
  explicit ColorMotions(const TextureOdometryParameters& parameters) : odometry_(parameters) {}

  void add(const RgbdFrame& frame, TrackedRecording& tracked) {
    const double stamp_s = frame.color_stamp_s.value_or(frame.stamp_s);
    const TextureOdometryResult motion = odometry_.process(frame);
    if (motion.found && stamp_s > last_s_)
      tracked.color_motions.push_back({last_s_, stamp_s, motion.T_previous_current});
    tracked.color_problem = motion.reason;
    last_s_ = stamp_s;
  }

 private:
  TextureOdometry odometry_;
  double last_s_ = 0.0;
};

// Reads the next frame, past those that cannot be read; the first of them is said.
std::optional<RgbdFrame> nextFrame(Recording& recording, const Say& say, size_t& unreadable) {
  while (true) {
    try {
      return recording.next();
    } catch (const Error& error) {
      if (unreadable++ == 0) say(std::string(error.what()) + "; left out");
      check(unreadable < recording.frameCount(),
            "no frame can be read; the last: " + std::string(error.what()));
    }
  }
}

}  // namespace

TrackedRecording track(ComputeContext& compute, Recording& recording, const PipelineParameters& parameters,
                       const TrackingRange& range, const Say& say) {
  TrackedRecording tracked;
  size_t unreadable = 0;
  for (size_t i = 0; i < range.first; ++i) nextFrame(recording, say, unreadable);
  std::unique_ptr<ReconstructionPipeline> pipeline;
  ColorMotions color_motions(parameters.texture_odometry);
  FrameChoice choice;
  std::string reason;
  while (range.count == 0 || tracked.read < range.count) {
    const std::optional<RgbdFrame> frame = nextFrame(recording, say, unreadable);
    if (!frame) break;
    if (!pipeline)
      pipeline = std::make_unique<ReconstructionPipeline>(compute, parameters, frame->intrinsics);
    ++tracked.read;
    color_motions.add(*frame, tracked);
    const TrackingResult result = pipeline->processFrame(*frame).tracking;
    if (result.status == TrackingStatus::kLost) {
      reason = result.reason;
      continue;
    }
    tracked.trajectory.push_back({frame->stamp_s, result.T_W_D});
    tracked.explained += result.explained;
    choice.offer(*frame, result.T_W_D);
    if (tracked.read % 100 == 0) say(std::to_string(tracked.read) + " frames tracked");
  }
  check(2 * tracked.trajectory.size() >= std::max<size_t>(tracked.read, 1),
        "only " + std::to_string(tracked.trajectory.size()) + " of " + std::to_string(tracked.read) +
            " frames could be tracked" + (reason.empty() ? "" : " (" + reason + ")") +
            "; calibration needs a recording that reconstruct can follow");
  // The first frame begins the map, which says nothing of how well it fits.
  tracked.explained /= std::max<double>(static_cast<double>(tracked.trajectory.size()) - 1.0, 1.0);
  tracked.frames = choice.take();
  for (CalibrationFrame& frame : tracked.frames)
    frame.velocity = velocityAt(tracked.trajectory, frame.frame.stamp_s);
  return tracked;
}

std::vector<MeasuredMotion> motionsOf(const Trajectory& trajectory) {
  std::vector<MeasuredMotion> motions;
  for (size_t i = 1; i < trajectory.size(); ++i) {
    const StampedPose &from = trajectory[i - 1], &to = trajectory[i];
    if (to.stamp_s - from.stamp_s > kMaxGap_s) continue;
    motions.push_back({from.stamp_s, to.stamp_s, from.T_W_D.inverse() * to.T_W_D});
  }
  return motions;
}

}  // namespace depth_fusion
