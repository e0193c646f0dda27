// What the nodelet tsdf_fusion is told.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "depth_fusion/pipeline/pipeline_parameters.h"
#include "ros/input/rgbd_parameters.h"
#include "ros/output/map_keeper_parameters.h"
#include "ros/output/map_refiner_parameters.h"
#include "ros/output/model_picture_parameters.h"

namespace depth_fusion {

struct TsdfFusionNodeletParameters {
  PipelineParameters pipeline;
  RgbdParameters rgbd;
  std::string device;
  std::string map_frame = "map";
  std::string tracking = "internal";
  std::string view_frame;  // empty: none
  int queue_size = 2;
  int tf_queue_size = 30;
  std::string on_clock_jump = "reset";
  ModelPictureParameters picture;
  MapKeeperParameters keeper;
  MapRefinerParameters refiner;

  // The nodelet's own rows.
  ParameterTable table();
  // The rows of the stages that the nodelet runs beside its own.
  std::vector<std::pair<std::string, ParameterTable>> stages();

  bool isExternal() const { return tracking == "external"; }
  // The frame that this nodelet sends for the view of rviz; with poses from icp_tracking, that one does.
  std::string viewFrame() const { return isExternal() ? view_frame : ""; }
  bool resetsOnClockJump() const { return on_clock_jump == "reset"; }
};

}  // namespace depth_fusion
