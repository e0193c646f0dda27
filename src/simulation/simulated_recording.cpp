#include "depth_fusion/simulation/simulated_recording.h"

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

constexpr double kFirstStamp_s = 1.0;  // ROS does not record a time of zero

}  // namespace

SimulatedRecording::SimulatedRecording(const SimulationOptions& options)
    : options_(options), scene_(makeScene(options.scene)) {
  check(options.frames > 0, "a simulated recording needs at least one frame");
  check(options.fps > 0.0 && options.speed > 0.0,
        "frame rate and speed of a simulated recording must be positive");
  check(options.intrinsics.valid(), "the intrinsics of a simulated recording must be positive");
}

StampedPose SimulatedRecording::poseOf(int frame) const {
  const double time_s = frame / options_.fps;
  return {kFirstStamp_s + time_s, handHeldPose(scene_.path, options_.seed, options_.speed * time_s)};
}

std::optional<RgbdFrame> SimulatedRecording::next() {
  if (next_frame_ >= options_.frames) return std::nullopt;
  const StampedPose pose = poseOf(next_frame_);
  const RenderedView view = render(scene_.surface, options_.intrinsics, pose.T_W_D);
  const uint64_t noise_seed = static_cast<uint64_t>(options_.seed) << 32 | static_cast<uint32_t>(next_frame_);
  ++next_frame_;

  RgbdFrame frame;
  frame.stamp_s = pose.stamp_s;
  frame.depth =
      options_.noise ? senseDepth(view, scene_.sensor, noise_seed) : idealDepth(view, scene_.sensor);
  frame.color = view.color;
  frame.intrinsics = options_.intrinsics;
  frame.T_W_D = pose.T_W_D;
  return frame;
}

std::string SimulatedRecording::description() const {
  return "simulated scene '" + options_.scene + "', " + std::to_string(options_.frames) + " frames, " +
         (options_.noise ? "with" : "without") + " noise";
}

}  // namespace depth_fusion
