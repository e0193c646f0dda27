#include "tools/simulation/simulated_recording.h"

#include <algorithm>
#include <functional>

#include "depth_fusion/common/error.h"
#include "depth_fusion/frames/known_attitude.h"
#include "depth_fusion/geometry/angles.h"

namespace depth_fusion {
namespace {

constexpr double kReadout_s = 0.03;

void checkOptions(const SimulationOptions& options, const SimulatedScene& scene) {
  check(options.frames > 0, "a simulated recording needs at least one frame");
  check(options.fps > 0.0 && options.speed > 0.0,
        "frame rate and speed of a simulated recording must be positive");
  check(options.linear_speed_m_s >= 0.0 && options.turn_rate_deg_s >= 0.0,
        "linear speed and turn rate of a simulated recording must not be negative");
  check(options.turn_rate_deg_s == 0.0 || scene.looks_around,
        "scene '" + options.scene +
            "' has no turn rate of its own: its camera turns as it walks; set the linear speed instead");
  check(options.tremor >= 0.0, "the tremor of a simulated recording must not be negative");
  check(options.intrinsics.valid(), "the intrinsics of a simulated recording must be positive");
}

Walk walkOf(const SimulatedScene& scene, const SimulationOptions& options) {
  if (options.walk.empty()) return {"", "", scene.path};
  std::string names;
  for (const Walk& walk : scene.walks) {
    if (walk.name == options.walk) return walk;
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
  const Walk walk = walkOf(scene_, options_);
  scene_.path = walk.path;
  if (walk.is_driven) options_.tremor = 0.0;
  if (options_.lifelike) {
    scene_.sensor.readout_s = kReadout_s;
    scene_.sensor.color = videoCamera();
  }
  if (options_.intrinsics.width == 0) options_.intrinsics = scene_.sensor.camera;
  checkOptions(options_, scene_);
  hand_speed_ = handSpeed(options_, scene_.path);
  if (options_.robot.has_wheels || options_.robot.has_imu)
    robot_.emplace(
        options_.robot,
        [path = scene_.path, options = options_, speed = hand_speed_](double time_s) {
          return handHeldPose(path, options.seed, speed, time_s, options.tremor);
        },
        walk.is_driven ? cameraOnRobot() : levelPose(kCameraUp), kFirstStamp_s, options_.seed);
}

Pose SimulatedRecording::poseAt(double time_s) const {
  return handHeldPose(scene_.path, options_.seed, hand_speed_, time_s, options_.tremor);
}

RenderedView SimulatedRecording::viewAt(double time_s) const {
  std::vector<Primitive> solids;
  if (scene_.also_seen) {
    solids = scene_.also_seen(poseAt(time_s), time_s);
    solids.insert(solids.end(), scene_.surface.primitives().begin(), scene_.surface.primitives().end());
  }
  const std::optional<Scene> more = solids.empty() ? std::nullopt : std::optional<Scene>(Scene(solids));
  const Scene& scene = more ? *more : scene_.surface;
  const CameraIntrinsics& camera = options_.intrinsics;
  const double readout_s = scene_.sensor.readout_s;
  if (readout_s <= 0.0) return render(scene, camera, poseAt(time_s));
  return renderRows(scene, camera, [&](int row) {
    return poseAt(time_s + readout_s * ((row + 0.5) / camera.height - 1.0));
  });
}

std::optional<RgbdFrame> SimulatedRecording::next() {
  if (next_frame_ >= options_.frames) return std::nullopt;
  const StampedPose pose = poseOf(next_frame_);
  const double time_s = next_frame_ / options_.fps, exposure_s = scene_.sensor.color.exposure_s;
  const RenderedView view = viewAt(time_s);
  const uint64_t noise_seed = static_cast<uint64_t>(options_.seed) << 32 | static_cast<uint32_t>(next_frame_);
  ++next_frame_;

  RgbdFrame frame;
  frame.stamp_s = pose.stamp_s;
  frame.depth =
      options_.noise ? senseDepth(view, scene_.sensor, noise_seed) : idealDepth(view, scene_.sensor);
  const ExposureMotion motion{poseAt(time_s - exposure_s / 2.0).inverse() * pose.T_W_D,
                              poseAt(time_s + exposure_s / 2.0).inverse() * pose.T_W_D};
  frame.color = senseColor(view, scene_.sensor.color, options_.intrinsics, motion, noise_seed);
  frame.intrinsics = options_.intrinsics;
  frame.T_W_D = pose.T_W_D;
  if (robot_) frame.readings = robot_->until(time_s);
  return frame;
}

std::string SimulatedRecording::description() const {
  return "simulated scene '" + options_.scene + "', " + std::to_string(options_.frames) + " frames, " +
         (options_.noise ? "with" : "without") + " noise";
}

}  // namespace depth_fusion
