#include "apps/benchmark/loop_inputs.h"

#include <algorithm>
#include <filesystem>
#include <iostream>

#include "apps/benchmark/tracking_inputs.h"
#include "depth_fusion/common/error.h"
#include "depth_fusion/recording/trajectory_file.h"
#include "depth_fusion/texture_odometry/texture_odometry.h"
#include "tools/simulation/simulated_recording.h"

namespace depth_fusion {
namespace {

struct Spacing {
  double m, rad;
};
constexpr Spacing kOfAWalk{0.3, 0.3}, kOfATable{0.05, 0.1}, kEveryFrame{0.0, 0.0};  // of keyframes
constexpr double kMaxPoseGap_s = 0.05;
constexpr int kViewWidth_px = 320;

// Makes keyframes of the frames that are far enough from the one before.
class KeyframeMaker {
 public:
  explicit KeyframeMaker(const Spacing& spacing) : odometry_({}), spacing_(spacing) {}

  void add(const RgbdFrame& frame, const Pose& T_W_D) {
    if (last_) {
      const Pose motion = last_->inverse() * T_W_D;
      way_m_ += (T_W_D.translation() - last_on_way_W_).norm();
      last_on_way_W_ = T_W_D.translation();
      if (motion.translation().norm() < spacing_.m && rotationAngle(motion) < spacing_.rad) return;
    }
    last_ = T_W_D;
    last_on_way_W_ = T_W_D.translation();
    Keyframe keyframe;
    keyframe.features = odometry_.extract(frame);
    keyframe.features.smoothed_levels.clear();
    keyframe.T_W_D = T_W_D;
    keyframe.stamp_s = frame.stamp_s;
    keyframe.way_m = way_m_;
    cv::Mat depth_m;
    frame.depth.convertTo(depth_m, CV_32F, frame.depth_unit_m);
    keyframe.view = KeyframeView(depth_m, frame.intrinsics, kViewWidth_px);
    keyframes.push_back(std::make_shared<const Keyframe>(std::move(keyframe)));
  }

  std::vector<KeyframePtr> keyframes;

 private:
  TextureOdometry odometry_;
  Spacing spacing_;
  std::optional<Pose> last_;
  Eigen::Vector3d last_on_way_W_ = Eigen::Vector3d::Zero();
  double way_m_ = 0.0;
};

LoopInput recordedLoops(const std::string& name, const std::string& folder, const Spacing& spacing,
                        const RecordingOptions& recording_options) {
  const std::unique_ptr<Recording> recording = openFolder(folder, recording_options);
  const Trajectory truth = readPoses(folder);
  KeyframeMaker maker(spacing);
  while (std::optional<RgbdFrame> frame = recording->next()) {
    const std::optional<Pose> T_W_D = poseAt(truth, frame->stamp_s, kMaxPoseGap_s);
    if (T_W_D) maker.add(*frame, *T_W_D);
  }
  return {name, std::move(maker.keyframes)};
}

// Its poses are an estimate, which is a decimetre off between some parts: keyframes 36 to 94 say so alike.
LoopInput ofApt0(const std::string& folder) {
  RecordingOptions options;
  options.intrinsics = CameraIntrinsics{640, 480, 582.871, 582.871, 320.0, 240.0};
  options.depth_unit_m = 0.001;
  LoopInput input = recordedLoops("apt0_keyframes", folder, kEveryFrame, options);
  input.wrong_m = 0.15;
  return input;
}

LoopInput simulatedLoops(const std::string& scene, const std::string& walk, double duration_s) {
  SimulationOptions options;
  options.scene = scene;
  options.walk = walk;
  options.fps = 1.5;
  options.frames = static_cast<int>(duration_s * options.fps);
  options.intrinsics = halved(makeScene(scene).sensor.camera);
  SimulatedRecording recording(options);
  KeyframeMaker maker(kOfAWalk);
  while (std::optional<RgbdFrame> frame = recording.next()) maker.add(*frame, *frame->T_W_D);
  return {scene + (walk.empty() ? "" : "_" + walk), std::move(maker.keyframes)};
}

struct Source {
  std::string name;
  std::string folder;  // empty: simulated
  std::function<LoopInput()> make;
};

std::vector<Source> sources(const LoopsOptions& options) {
  const std::string data = dataFolder(options.data);
  const std::string apt0 = data + "/apt0_keyframes", redkitchen = data + "/redkitchen";
  return {{"apt0_keyframes", apt0, [=] { return ofApt0(apt0); }},
          {"redkitchen", redkitchen, [=] { return recordedLoops("redkitchen", redkitchen, kOfATable, {}); }},
          {"building_loop", "", [] { return simulatedLoops("building", "loop", 620.0); }},
          {"building_laps", "", [] { return simulatedLoops("building", "laps", 470.0); }},
          {"repeated_corridor", "", [] { return simulatedLoops("repeated_corridor", "", 125.0); }},
          {"alike", "", [] { return simulatedLoops("alike", "", 60.0); }}};
}

}  // namespace

void forEachLoopInput(const LoopsOptions& options, const std::function<void(const LoopInput&)>& visit) {
  const std::vector<Source> all = sources(options);
  const auto isChosen = [&](const Source& source) {
    return options.inputs.empty() ||
           std::find(options.inputs.begin(), options.inputs.end(), source.name) != options.inputs.end();
  };
  for (const std::string& name : options.inputs) {
    std::string names;
    for (const Source& source : all) names += (names.empty() ? "" : ", ") + source.name;
    check(std::any_of(all.begin(), all.end(), [&](const Source& source) { return source.name == name; }),
          "there is no input '" + name + "'; the inputs are: " + names);
  }
  for (const Source& source : all) {
    if (!isChosen(source)) continue;
    if (!source.folder.empty() && !std::filesystem::exists(source.folder)) {
      std::cout << "there is no " << source.folder << "; see --data" << std::endl;
      continue;
    }
    visit(source.make());
  }
}

}  // namespace depth_fusion
