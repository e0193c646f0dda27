// The first frames of the simulated room, and a map that is coarse enough to fuse them quickly.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "depth_fusion/pipeline/pipeline_parameters.h"
#include "tools/simulation/simulated_recording.h"

namespace depth_fusion {

// Parameters with voxels of 2 cm.
inline PipelineParameters coarseRoomParameters() {
  PipelineParameters parameters;
  parameters.map.voxel_size_m = 0.02f;
  parameters.map.truncation_m = 0.08f;
  parameters.map.blocks_per_axis = 64;
  parameters.map.pool_mib = 32;
  return parameters;
}

// Frames of the room seen by a slowly moving camera.
inline std::vector<RgbdFrame> simulateRoom(const CameraIntrinsics& camera, int count) {
  SimulationOptions options;
  options.frames = count;
  options.intrinsics = camera;
  SimulatedRecording recording(options);
  std::vector<RgbdFrame> frames;
  while (std::optional<RgbdFrame> frame = recording.next()) frames.push_back(std::move(*frame));
  return frames;
}

}  // namespace depth_fusion
