// What the nodelet icp_tracking is told.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "ros/in_process/live_tracker_parameters.h"
#include "ros/input/rgbd_parameters.h"
#include "ros/output/pose_parameters.h"

namespace depth_fusion {

struct IcpTrackingNodeletParameters {
  LiveTrackerParameters tracker;
  RgbdParameters rgbd;  // without texture odometry
  PoseParameters pose;
  int queue_size = 1;

  // The nodelet's own rows.
  ParameterTable table();
  // The rows of the stages that the nodelet runs beside its own.
  std::vector<std::pair<std::string, ParameterTable>> stages();
};

}  // namespace depth_fusion
