#include "apps/benchmark/tracking_inputs.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "depth_fusion/common/error.h"
#include "depth_fusion/recording/trajectory_file.h"
#include "depth_fusion/registration/registered_recording.h"
#include "tools/simulation/simulated_recording.h"

namespace depth_fusion {
namespace {

TrackingInput simulated(const std::string& name, const std::string& scene, double linear_speed_m_s = 0.0,
                        double turn_rate_deg_s = 0.0) {
  SimulationOptions options;
  options.scene = scene;
  options.linear_speed_m_s = linear_speed_m_s;
  options.turn_rate_deg_s = turn_rate_deg_s;
  return simulatedInput(name, options);
}

TrackingInput recorded(const std::string& name, const std::string& folder, const std::string& params,
                       const std::string& camera) {
  TrackingInput input;
  input.name = name;
  RecordingOptions options;
  if (!camera.empty()) readCamera(camera, options);
  if (!params.empty()) loadParameterFile(input.parameters.table(), params);
  input.parameters.model_view.half_size =
      false;  // to compare with other inputs, and with benchmarks of before
  input.open = [folder, options, compute = std::make_shared<ComputeContext>(),
                parameters = input.parameters.registration] {
    return registered(openFolder(folder, options), *compute, parameters);
  };
  input.truth = readPoses(folder);
  return input;
}

TrackingInput atTenHertz(TrackingInput input) {
  input.name += "_10hz";
  input.open = [open = input.open] { return everyNth(open(), 3); };
  return input;
}

TrackingInput withInterruption(TrackingInput input, const std::string& what,
                               const Interruption& interruption) {
  input.name += what;
  input.open = [open = input.open, interruption] { return interrupted(open, interruption); };
  input.truth = repeated(input.truth);
  return input;
}

std::vector<TrackingInput> allInputs(const TrackingBenchmark& options) {
  const TrackingInput white_room = simulated("white_room", "white_room");
  std::vector<TrackingInput> inputs = {simulated("wall", "wall"),
                                       simulated("floor_wall", "floor_wall"),
                                       simulated("cylinder", "cylinder"),
                                       white_room,
                                       withInterruption(white_room, "_jump", {0, 50}),
                                       simulated("room_fast", "room", 0.5, 60.0)};
  for (const TrackingInput& input : recordedInputs(options)) {
    inputs.push_back(input);
    if (input.name != "tum_fr1_xyz") continue;
    inputs.insert(inputs.end(), {atTenHertz(input), withInterruption(input, "_blackout", {30, 100}),
                                 withInterruption(input, "_jump", {0, 100})});
  }
  return inputs;
}

}  // namespace

std::string dataFolder(const std::string& chosen) {
  if (!chosen.empty()) return chosen;
  const char* folder = std::getenv("DEPTH_FUSION_DATA");
  return folder != nullptr ? folder : "../shared/data";
}

TrackingInput roomInput(int frames) {
  SimulationOptions options;
  options.frames = frames;
  TrackingInput input;
  input.name = "room";
  input.open = [options] { return std::make_unique<SimulatedRecording>(options); };
  return input;
}

std::vector<RgbdFrame> framesOf(const TrackingInput& input) {
  const std::unique_ptr<Recording> recording = input.open();
  std::vector<RgbdFrame> frames;
  while (std::optional<RgbdFrame> frame = recording->next()) frames.push_back(std::move(*frame));
  check(!frames.empty(), input.name + " has no frames");
  return frames;
}

TrackingInput simulatedInput(const std::string& name, const SimulationOptions& options) {
  TrackingInput input;
  input.name = name;
  input.open = [options] { return std::make_unique<SimulatedRecording>(options); };
  const SimulatedRecording recording(options);
  for (int i = 0; i < options.frames; ++i) input.truth.push_back(recording.poseOf(i));
  return input;
}

std::vector<TrackingInput> recordedInputs(const TrackingBenchmark& options) {
  struct Known {
    std::string name, params, camera;
  };
  const std::string data = dataFolder(options.data);
  const std::string kinect = options.cfg + "/kinect_v1.yaml";
  std::vector<TrackingInput> inputs;
  for (const Known& known :
       {Known{"tum_fr1_xyz", kinect, options.cfg + "/cameras/tum_freiburg1.yaml"},
        Known{"redkitchen", kinect, ""}, Known{"icl_office_kt0", "", data + "/icl_office_kt0/camera.yaml"}}) {
    const std::string folder = data + "/" + known.name;
    if (std::filesystem::exists(folder)) {
      inputs.push_back(recorded(known.name, folder, known.params, known.camera));
      inputs.back().truth_is_estimate = known.name == "redkitchen";
    } else {
      std::cout << "there is no " << folder << "; see --data" << std::endl;
    }
  }
  return inputs;
}

std::vector<TrackingInput> chosenOf(const std::vector<TrackingInput>& all, const TrackingBenchmark& options) {
  if (options.inputs.empty()) return all;
  std::vector<TrackingInput> chosen;
  for (const std::string& name : options.inputs) {
    const auto input =
        std::find_if(all.begin(), all.end(), [&](const TrackingInput& i) { return i.name == name; });
    std::string names;
    for (const TrackingInput& known : all) names += (names.empty() ? "" : ", ") + known.name;
    check(input != all.end(), "there is no input '" + name + "'; the inputs are: " + names);
    chosen.push_back(*input);
  }
  return chosen;
}

std::vector<TrackingInput> trackingInputs(const TrackingBenchmark& options) {
  return chosenOf(allInputs(options), options);
}

}  // namespace depth_fusion
