#include "depth_fusion/pipeline/pipeline_parameters.h"

#include <utility>

namespace depth_fusion {

ParameterTable PipelineParameters::table() {
  ParameterTable all;
  for (const auto& [stage, table] :
       {std::make_pair("map", map.table()), std::make_pair("registration", registration.table()),
        std::make_pair("depth_sensor", depth_sensor.table()),
        std::make_pair("preprocessing", preprocessing.table()),
        std::make_pair("texture_odometry", texture_odometry.table()),
        std::make_pair("icp_tracking", icp_tracking.table()),
        std::make_pair("relocalisation", relocalisation.table()),
        std::make_pair("tsdf_fusion", tsdf_fusion.table()),
        std::make_pair("color_fusion", color_fusion.table()),
        std::make_pair("model_view", model_view.table()),
        std::make_pair("surface_mesh", surface_mesh.table())}) {
    const ParameterTable rows = withPrefix(stage, table);
    all.insert(all.end(), rows.begin(), rows.end());
  }
  return all;
}

}  // namespace depth_fusion
