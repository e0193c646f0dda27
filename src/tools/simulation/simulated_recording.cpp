#include "tools/simulation/simulated_recording.h"

#include <algorithm>
#include <functional>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

constexpr double kFirstStamp_s = 1.0;  // ROS does not record a time of zero

constexpr double kRadPerDeg = 3.141592653589793 / 180.0;

void checkOptions(const SimulationOptions& options, const SimulatedScene& scene) {
  check(options.frames > 0, "a simulated recording needs at least one frame");
  check(options.fps > 0.0 && options.speed > 0.0,
        "frame rate and speed of a simulated recording must be positive");
  check(options.linear_speed_m_s >= 0.0 && options.turn_rate_deg_s >= 0.0,
        "linear speed and turn rate of a simulated recording must not be negative");
  check(options.turn_rate_deg_s == 0.0 || scene.looks_around,
        "scene '" + options.scene +
            "' has no turn rate of its own: its camera turns as it walks; set the linear speed instead");
  check(options.intrinsics.valid(), "the intrinsics of a simulated recording must be positive");
}

GazePath pathOf(const SimulatedScene& scene, const SimulationOptions& options) {
  if (options.walk.empty()) return scene.path;
  std::string names;
  for (const Walk& walk : scene.walks) {
    if (walk.name == options.walk) return walk.path;
    names += (names.empty() ? "; its walks are " : ", ") + walk.name;
  }
  throw Error("scene '" + options.scene + "' has no walk '" + options.walk + "'" +
              (names.empty() ? "; it has one path only" : names));
}

// Finds the speed at which the fastest moment of a recording has the given rate. A faster hand gets further
// along the path, so that it may meet a faster part of it.
double speedForPeak(const std::function<double(double)>& rate_at, double peak_rate, double duration_s) {
  const double step_s = duration_s / 1000.0;
  double fastest = 0.0, path_time_s = 0.0;
  while (fastest * path_time_s < peak_rate * duration_s) {
    path_time_s += step_s;
    fastest = std::max(fastest, rate_at(path_time_s));
  }
  return path_time_s / duration_s;
}

HandSpeed handSpeed(const SimulationOptions& options, const GazePath& path) {
  const double duration_s = options.frames / options.fps;
  const auto linear_m_s = [&](double time_s) { return ratesAt(path, options.seed, time_s).linear_m_s; };
  const auto turn_rad_s = [&](double time_s) { return ratesAt(path, options.seed, time_s).turn_rad_s; };
  HandSpeed speed{options.speed, options.speed};
  if (options.linear_speed_m_s > 0.0) {
    speed.walk = speedForPeak(linear_m_s, options.linear_speed_m_s, duration_s);
  }
  if (options.turn_rate_deg_s > 0.0) {
    speed.look = speedForPeak(turn_rad_s, options.turn_rate_deg_s * kRadPerDeg, duration_s);
  }
  return speed;
}

}  // namespace

SimulatedRecording::SimulatedRecording(const SimulationOptions& options)
    : options_(options), scene_(makeScene(options.scene)) {
  scene_.path = pathOf(scene_, options_);
  if (options_.intrinsics.width == 0) options_.intrinsics = scene_.sensor.camera;
  checkOptions(options_, scene_);
  hand_speed_ = handSpeed(options_, scene_.path);
}

StampedPose SimulatedRecording::poseOf(int frame) const {
  const double time_s = frame / options_.fps;
  return {kFirstStamp_s + time_s, handHeldPose(scene_.path, options_.seed, hand_speed_, time_s)};
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
