// The parameters of all the stages.
#pragma once

#include "depth_fusion/color_fusion/color_fusion.h"
#include "depth_fusion/icp_tracking/icp_tracker.h"
#include "depth_fusion/map/block_sparse_map.h"
#include "depth_fusion/model_view/model_view.h"
#include "depth_fusion/preprocessing/depth_preprocessor.h"
#include "depth_fusion/registration/frame_registration.h"
#include "depth_fusion/relocalisation/relocaliser.h"
#include "depth_fusion/surface_mesh/surface_mesh.h"
#include "depth_fusion/texture_odometry/texture_odometry.h"
#include "depth_fusion/tsdf_fusion/tsdf_fusion.h"

namespace depth_fusion {

struct PipelineParameters {
  MapParameters map;
  RegistrationParameters registration;
  DepthSensorParameters depth_sensor;
  PreprocessingParameters preprocessing;
  TextureOdometryParameters texture_odometry;
  IcpTrackingParameters icp_tracking;
  RelocalisationParameters relocalisation;
  FusionParameters tsdf_fusion;
  ColorFusionParameters color_fusion;
  ModelViewParameters model_view;
  SurfaceMeshParameters surface_mesh;

  // The rows of all the stages, named "<stage>/<name>".
  ParameterTable table();
};

// Where the sensor's noise limits the range, every stage goes by it.
PipelineParameters withinSensorRange(PipelineParameters parameters);

}  // namespace depth_fusion
