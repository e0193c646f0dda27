// What a stored map says of itself.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "depth_fusion/common/parameters.h"
#include "depth_fusion/geometry/camera_intrinsics.h"
#include "depth_fusion/geometry/pose.h"
#include "depth_fusion/map/window.h"

namespace depth_fusion {

struct SubmapDescription {
  uint32_t id = 0;
  Pose T_W_S = Pose::Identity();
  Window window;
  uint64_t blocks = 0;
  double left_at_m = 0.0;  // on the sensor's way, when it was active last
};

// The parameters that say where a map's voxels are, and what their distances mean.
constexpr const char* kVoxelParameters[] = {"map/voxel_size_m", "map/block_size", "map/truncation_m"};

struct MapDescription {
  uint64_t id = 0;          // a random number, made with the map
  uint64_t revision = 0;    // counts the times that it was written
  double saved_at_s = 0.0;  // Unix time
  std::string software;     // what wrote it, with its version
  std::vector<std::pair<std::string, std::string>>
      parameters;           // of what was fused, by the names of their rows
  CameraIntrinsics camera;  // of the depth that was fused
  StampedPose last_pose;    // of the sensor
  double way_m = 0.0;       // of the sensor so far, where its poses are tracked
  uint32_t active_submap = 0;
  std::vector<std::string> layers;
  std::vector<SubmapDescription> submaps;  // in rows of their own

  // A parameter's value as text. Throws Error for one that is not there.
  const std::string& parameter(const std::string& name) const;
};

// Throws Error if the parameter, of which `present` has the row, has another value than the stored map was
// made with; `name` is the map's.
void checkSameParameter(const MapDescription& stored, const std::string& parameter,
                        const ParameterTable& present, const std::string& name);

}  // namespace depth_fusion
