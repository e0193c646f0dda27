#include "ros/nodelets/tsdf_fusion_nodelet_parameters.h"

#include "ros/parameters/shared_rows.h"

namespace depth_fusion {

ParameterTable TsdfFusionNodeletParameters::table() {
  const ParameterTable own = {
      deviceRow(device),
      atStartOnly(text("map_frame", &map_frame, "frame of the map")),
      atStartOnly(
          choice("tracking", &tracking, {"internal", "external"},
                 "internal: frames with poses from icp_tracking; external: frames from the topics, poses "
                 "from tf at their stamps")),
      atStartOnly(text("view_frame", &view_frame,
                       "external: a frame on tf that follows the camera and stays level, for the view of "
                       "rviz; empty: none")),
      queueSizeRow(queue_size),
      atStartOnly(number("tf_queue_size", &tf_queue_size, 1, 10000,
                         "external: frames that wait for their pose at most")),
      choice("on_clock_jump", &on_clock_jump, {"reset", "keep"},
             "external: what a clock that goes back does to the map")};
  return joined(
      {pipeline.tsdf_fusion.table(), rgbd.table(), own, keeper.table(), refiner.table(), picture.table()});
}

std::vector<std::pair<std::string, ParameterTable>> TsdfFusionNodeletParameters::stages() {
  return {{"map", pipeline.map.table()},
          {"submaps", pipeline.submaps.table()},
          {"registration", rgbd.registration.table()},
          {"masking", rgbd.masking.table()},
          {"depth_sensor", pipeline.depth_sensor.table()},
          {"preprocessing", pipeline.preprocessing.table()},
          {"model_view", pipeline.model_view.table()},
          {"color_fusion", pipeline.color_fusion.table()},
          {"loops", pipeline.loops.table()}};
}

}  // namespace depth_fusion
