#include "depth_fusion/pipeline/pipeline_parameters.h"

namespace depth_fusion {

ParameterTable PipelineParameters::table() {
  return joined(
      {withPrefix("map", map.table()), withPrefix("submaps", submaps.table()),
       withPrefix("registration", registration.table()), withPrefix("depth_sensor", depth_sensor.table()),
       withPrefix("preprocessing", preprocessing.table()),
       withPrefix("texture_odometry", texture_odometry.table()),
       withPrefix("icp_tracking", icp_tracking.table()), withPrefix("drift", drift.table()),
       withPrefix("relocalisation", relocalisation.table()), withPrefix("robot_motion", robot_motion.table()),
       withPrefix("loops", loops.table()), withPrefix("tsdf_fusion", tsdf_fusion.table()),
       withPrefix("color_fusion", color_fusion.table()), withPrefix("model_view", model_view.table()),
       withPrefix("surface_mesh", surface_mesh.table())});
}

}  // namespace depth_fusion
