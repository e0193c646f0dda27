// What trackers are tried on: scenes that leave directions free, fast hands, real recordings, and those made
// harder.
#pragma once

#include "apps/benchmark/tracking.h"
#include "depth_fusion/pipeline/reconstruction_pipeline.h"
#include "tools/simulation/altered_recording.h"
#include "tools/simulation/simulated_recording.h"

namespace depth_fusion {

constexpr double kWrong_m = 0.05;  // a tracked pose that is farther from the truth is wrong

struct TrackingInput {
  std::string name;
  OpenRecording open;
  Trajectory truth;
  bool truth_is_estimate = false;  // of another tracker
  PipelineParameters parameters;
};

// Returns `chosen`, or if it is empty $DEPTH_FUSION_DATA, or else ../shared/data.
std::string dataFolder(const std::string& chosen);

// Returns the simulated room, without its truth.
TrackingInput roomInput(int frames);

TrackingInput simulatedInput(const std::string& name, const SimulationOptions& options);
// The real and rendered recordings that are there.
std::vector<TrackingInput> recordedInputs(const TrackingBenchmark& options);
// Those of `all` that options.inputs names, or all. Throws Error for a name that is not known.
std::vector<TrackingInput> chosenOf(const std::vector<TrackingInput>& all, const TrackingBenchmark& options);

// The inputs of the table, chosen alike.
std::vector<TrackingInput> trackingInputs(const TrackingBenchmark& options);

// Reads all the frames at once, for several runs.
std::vector<RgbdFrame> framesOf(const TrackingInput& input);

}  // namespace depth_fusion
