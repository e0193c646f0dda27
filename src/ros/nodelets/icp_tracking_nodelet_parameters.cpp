#include "ros/nodelets/icp_tracking_nodelet_parameters.h"

#include "ros/parameters/shared_rows.h"

namespace depth_fusion {

ParameterTable IcpTrackingNodeletParameters::table() {
  return joined({tracker.pipeline.icp_tracking.table(),
                 rgbd.table(),
                 pose.table(),
                 tracker.table(),
                 {queueSizeRow(queue_size)}});
}

std::vector<std::pair<std::string, ParameterTable>> IcpTrackingNodeletParameters::stages() {
  return {{"registration", rgbd.registration.table()},
          {"masking", rgbd.masking.table()},
          {"depth_sensor", tracker.pipeline.depth_sensor.table()},
          {"preprocessing", tracker.pipeline.preprocessing.table()},
          {"drift", tracker.pipeline.drift.table()},
          {"relocalisation", tracker.pipeline.relocalisation.table()},
          {"robot_motion", tracker.pipeline.robot_motion.table()}};
}

}  // namespace depth_fusion
