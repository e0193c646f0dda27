#include "apps/texture/inputs.h"

#include "depth_fusion/common/error.h"
#include "depth_fusion/frames/y_down.h"
#include "depth_fusion/pipeline/pipeline_parameters.h"
#include "depth_fusion/recording/trajectory_file.h"
#include "depth_fusion/registration/registered_recording.h"
#include "depth_fusion/surface_mesh/ply.h"
#include "depth_fusion/texturing/keyframe_views.h"
#include "pipeline/open_map.h"
#include "ros/bags/open_recording.h"

namespace depth_fusion {
namespace {

constexpr double kMaxPoseGap_s = 0.1;

TextureInput readMap(const TextureArguments& arguments) {
  const auto database = openDatabase(arguments.map, DatabaseAccess::kRead);
  ComputeContext compute(arguments.device);
  OpenMap map(compute, {}, *database);
  TextureInput input{{}, viewsOf(map.loaded().keyframes)};
  check(!input.views.empty(),
        map.name() + ": none of its " + std::to_string(map.loaded().keyframes.size()) +
            " keyframes has a picture; save it with colour (reconstruct --color --map, or "
            "color:=true), or give the recording");
  if (arguments.mesh.empty())
    map.exportMesh(input.mesh);
  else
    input.mesh = readPly(arguments.mesh);
  return input;
}

// The next frame; what cannot be read is counted.
std::optional<RgbdFrame> nextFrame(Recording& recording, size_t& unreadable) {
  while (true) {
    try {
      return recording.next();
    } catch (const Error&) {
      check(++unreadable < recording.frameCount(), "no frame of the recording can be read");
    }
  }
}

TextureInput readRecording(const TextureArguments& arguments) {
  check(!arguments.trajectory.empty() && !arguments.mesh.empty(),
        "a recording needs its mesh and its trajectory, as reconstruct writes them (mesh.ply and "
        "trajectory.txt): "
        "give --reconstruction, or --mesh and --trajectory");
  RecordingOptions options = arguments.recording_options;
  if (!arguments.color_camera_file.empty()) readColorCamera(arguments.color_camera_file, options);
  TextureInput input;
  input.mesh = readPly(arguments.mesh);
  const Trajectory poses = readPoses(arguments.trajectory);
  ComputeContext compute(arguments.device);
  const auto recording = registered(openRecordings(arguments.recording, options), compute, {});
  size_t frames = 0, unreadable = 0;
  std::string problem;
  while (const std::optional<RgbdFrame> frame = nextFrame(*recording, unreadable)) {
    ++frames;
    const std::optional<Pose> T_W_D = poseAt(poses, frame->stamp_s, kMaxPoseGap_s);
    const KeyframeColor color = T_W_D ? colorOf(*frame) : KeyframeColor();
    if (T_W_D && color.jpeg.empty()) problem = colorProblem(*frame);
    if (color.jpeg.empty()) continue;
    input.views.push_back(viewOf(color, frame->y_mirrored ? mirroredY(*T_W_D) : *T_W_D));
  }
  check(!input.views.empty(), namesOf(arguments.recording) + ": none of its " + std::to_string(frames) +
                                  " frames has a picture and a pose in " + arguments.trajectory +
                                  (problem.empty() ? "" : " (" + problem + ")"));
  return input;
}

}  // namespace

TextureInput readTextureInput(const TextureArguments& arguments) {
  return arguments.map.empty() ? readRecording(arguments) : readMap(arguments);
}

}  // namespace depth_fusion
