#include "depth_fusion/pipeline/stored_map.h"

namespace depth_fusion {
namespace {

constexpr char kRule[] = "tsdf_fusion/rule";  // a voxel's certainty means something else by another one

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
  const ParameterTable table = parameters.table();
  for (const char* name : kVoxelParameters) setParameter(table, name, stored.parameter(name));
  setParameter(table, kRule, stored.parameter(kRule));
}

void checkFilterRule(const MapDescription& stored, PipelineParameters parameters, const std::string& name) {
  checkSameParameter(stored, kRule, parameters.table(), name);
}

}  // namespace depth_fusion
