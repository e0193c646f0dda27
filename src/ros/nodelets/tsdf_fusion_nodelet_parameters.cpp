#include "ros/nodelets/tsdf_fusion_nodelet_parameters.h"

namespace depth_fusion {

ParameterTable TsdfFusionNodeletParameters::table(const Parameter& device_row,
                                                  const Parameter& queue_size_row) {
  const ParameterTable own = {
      device_row,
      {"map_frame", &map_frame, 0, 0, "frame of the map", {}, true},
      {"tracking",
       &tracking,
       0,
       0,
       "internal: frames with poses from icp_tracking; external: frames from the topics, poses from tf at "
       "their stamps",
       {"internal", "external"},
       true},
      queue_size_row,
      {"tf_queue_size",
       &tf_queue_size,
       1,
       10000,
       "external: frames that wait for their pose at most",
       {},
       true},
      {"on_clock_jump",
       &on_clock_jump,
       0,
       0,
       "external: what a clock that goes back does to the map",
       {"reset", "keep"}}};
  ParameterTable table = pipeline.tsdf_fusion.table();
  for (const ParameterTable& rows : {rgbd.table(), own, picture.table()})
    table.insert(table.end(), rows.begin(), rows.end());
  return table;
}

std::vector<std::pair<std::string, ParameterTable>> TsdfFusionNodeletParameters::stages() {
  return {{"map", pipeline.map.table()},
          {"registration", rgbd.registration.table()},
          {"depth_sensor", pipeline.depth_sensor.table()},
          {"preprocessing", pipeline.preprocessing.table()},
          {"model_view", pipeline.model_view.table()},
          {"color_fusion", pipeline.color_fusion.table()}};
}

}  // namespace depth_fusion
