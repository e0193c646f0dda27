#include "depth_fusion/pipeline/stored_map.h"

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

// What a voxel's place and its bytes depend on.
constexpr char kRule[] = "tsdf_fusion/rule";
constexpr const char* kFixed[] = {"map/voxel_size_m", "map/block_size", "map/truncation_m", kRule};

}  // namespace

MapDescription descriptionOf(PipelineParameters parameters, const CameraIntrinsics& camera,
                             const StampedPose& last_pose) {
  MapDescription description;
  const ParameterTable of_the_map = joined({withPrefix("map", parameters.map.table()),
                                            withPrefix("depth_sensor", parameters.depth_sensor.table()),
                                            withPrefix("preprocessing", parameters.preprocessing.table()),
                                            withPrefix("tsdf_fusion", parameters.tsdf_fusion.table()),
                                            withPrefix("color_fusion", parameters.color_fusion.table())});
  for (const Parameter& row : of_the_map) description.parameters.emplace_back(row.name, valueText(row));
  description.camera = camera;
  description.last_pose = last_pose;
  return description;
}

void adoptParameters(const MapDescription& stored, PipelineParameters& parameters) {
  for (const char* name : kFixed) setParameter(parameters.table(), name, stored.parameter(name));
}

void checkFilterRule(const MapDescription& stored, PipelineParameters parameters, const std::string& name) {
  const std::string& theirs = stored.parameter(kRule);
  const std::string ours = valueText(findParameter(parameters.table(), kRule));
  check(theirs == ours, name + " was made with " + kRule + " " + theirs + ", and here it is " + ours +
                            "; set it to " + theirs);
}

}  // namespace depth_fusion
