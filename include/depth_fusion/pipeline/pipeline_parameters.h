// The parameters of all the stages.
#pragma once

#include "depth_fusion/color_fusion/color_fusion_parameters.h"
#include "depth_fusion/frames/depth_sensor.h"
#include "depth_fusion/icp_tracking/icp_tracking_parameters.h"
#include "depth_fusion/loops/loop_parameters.h"
#include "depth_fusion/map/map_parameters.h"
#include "depth_fusion/model_view/model_view_parameters.h"
#include "depth_fusion/pipeline/drift_parameters.h"
#include "depth_fusion/preprocessing/preprocessing_parameters.h"
#include "depth_fusion/registration/registration_parameters.h"
#include "depth_fusion/relocalisation/relocalisation_parameters.h"
#include "depth_fusion/robot_motion/robot_motion_parameters.h"
#include "depth_fusion/submaps/submap_parameters.h"
#include "depth_fusion/surface_mesh/surface_mesh_parameters.h"
#include "depth_fusion/texture_odometry/texture_odometry_parameters.h"
#include "depth_fusion/tsdf_fusion/tsdf_fusion_parameters.h"

namespace depth_fusion {

struct PipelineParameters {
  MapParameters map;
  SubmapParameters submaps;
  RegistrationParameters registration;
  DepthSensorParameters depth_sensor;
  PreprocessingParameters preprocessing;
  TextureOdometryParameters texture_odometry;
  IcpTrackingParameters icp_tracking;
  DriftParameters drift;
  RelocalisationParameters relocalisation;
  RobotMotionParameters robot_motion;
  LoopParameters loops;
  TsdfFusionParameters tsdf_fusion;
  ColorFusionParameters color_fusion;
  ModelViewParameters model_view;
  SurfaceMeshParameters surface_mesh;

  // The rows of all the stages, named "<stage>/<name>".
  ParameterTable table();
  // The depth that every stage uses.
  DepthRange depthRange() const { return depth_fusion::depthRange(preprocessing, depth_sensor); }
};

}  // namespace depth_fusion
