#include <utility>

#include "apps/benchmark/starts.h"

namespace depth_fusion {
namespace {

constexpr int kFrames = 150;
constexpr unsigned kNoiseSeed = 7;

struct SceneInput {
  const char* name;
  const char* scene;
  bool lifelike = false, noise = true;
  double linear_speed_m_s = 0.0, turn_rate_deg_s = 0.0;
  int frames = 300;
};

// Bare surfaces, fast rotations, things that are alike, close range, rooms with and without noise.
constexpr SceneInput kScenes[] = {{"wall", "wall"},
                                  {"floor_wall", "floor_wall"},
                                  {"cylinder", "cylinder"},
                                  {"white_room", "white_room"},
                                  {"room_fast", "room", false, true, 0.5, 60.0},
                                  {"room_spun", "room", true, true, 0.6, 150.0, kFrames},
                                  {"shaken", "shaken", true, true, 0.0, 0.0, kFrames},
                                  {"alike", "alike", true, true, 0.0, 0.0, kFrames},
                                  {"large_room", "large_room", true, true, 0.0, 0.0, kFrames},
                                  {"large_room_exact", "large_room", false, false, 0.0, 0.0, kFrames},
                                  {"corridor", "corridor", false, true, 0.0, 0.0, kFrames},
                                  {"close", "object", false, true, 0.0, 0.0, kFrames}};

TrackingInput inputOf(const SceneInput& scene) {
  SimulationOptions options;
  options.scene = scene.scene;
  options.lifelike = scene.lifelike;
  options.noise = scene.noise;
  options.linear_speed_m_s = scene.linear_speed_m_s;
  options.turn_rate_deg_s = scene.turn_rate_deg_s;
  options.frames = scene.frames;
  options.intrinsics = makeScene("room").sensor.camera;
  TrackingInput input = simulatedInput(scene.name, options);
  if (scene.lifelike) input.parameters.preprocessing.readout_s = 0.03f;
  return input;
}

// A rendered recording as the default sensor sees it.
TrackingInput noisy(TrackingInput input) {
  input.name += "_noise";
  input.open = [open = input.open, parameters = input.parameters] {
    return withNoise(open(), parameters.depth_sensor, parameters.depthRange(), kNoiseSeed);
  };
  return input;
}

}  // namespace

std::vector<TrackingInput> startInputs(const TrackingBenchmark& options) {
  std::vector<TrackingInput> inputs;
  for (const SceneInput& scene : kScenes) inputs.push_back(inputOf(scene));
  for (TrackingInput& input : recordedInputs(options)) {
    inputs.push_back(input);
    if (input.name == "icl_office_kt0") inputs.push_back(noisy(std::move(input)));
  }
  return chosenOf(inputs, options);
}

}  // namespace depth_fusion
