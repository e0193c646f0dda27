// One frame's way through all the stages.
#pragma once

#include "depth_fusion/icp_tracking/icp_tracker.h"
#include "depth_fusion/model_view/model_view.h"
#include "depth_fusion/surface_mesh/surface_mesh.h"
#include "depth_fusion/texture_odometry/texture_odometry.h"
#include "depth_fusion/tsdf_fusion/tsdf_fusion.h"

namespace depth_fusion {

struct PipelineParameters {
  MapParameters map;
  DepthSensorParameters depth_sensor;
  PreprocessingParameters preprocessing;
  TextureOdometryParameters texture_odometry;
  IcpTrackingParameters icp_tracking;
  FusionParameters tsdf_fusion;
  SurfaceMeshParameters surface_mesh;

  // The rows of all the stages, named "<stage>/<name>".
  ParameterTable table();
};

struct FrameResult {
  TrackingResult tracking;
  FusionResult fusion;  // all zero if the frame was not fused
};

// Tracks and fuses frame by frame. W is the first fused frame's camera frame, or that of the given
// poses.
class ReconstructionPipeline {
 public:
  ReconstructionPipeline(ComputeContext& compute, const PipelineParameters& parameters,
                         const CameraIntrinsics& camera);

  // A lost frame changes nothing in the map; the next one is tried against the same view.
  FrameResult processFrame(const RgbdFrame& frame);

  // The same with a pose from elsewhere in place of tracking; lost only if there is no depth.
  FrameResult processFrame(const RgbdFrame& frame, const Pose& T_W_D);

  BlockSparseMap& map() { return map_; }
  StageTimers& timers() { return timers_; }
  const PipelineParameters& parameters() const { return parameters_; }

 private:
  const DepthFrame& preprocess(const RgbdFrame& frame);
  // From the texture's motion since the frame before; the last pose without one.
  MotionPrior prior(const RgbdFrame& frame);
  // The first pose, if the frame has enough depth for the next one to be tracked against.
  TrackingResult begin(const RgbdFrame& frame) const;
  // Lost if nothing could be fused.
  void fuse(const RgbdFrame& frame, const DepthFrame& depth, FrameResult& result);

  ComputeContext& compute_;
  PipelineParameters parameters_;
  StageTimers timers_;
  BlockSparseMap map_;
  DepthPreprocessor preprocessor_;
  TextureOdometry odometry_;
  IcpTracker tracker_;
  TsdfFusion fusion_;
  ModelViewRenderer renderer_;
  const ModelView* view_ = nullptr;  // of the last fused frame; none before the first
  MotionPrior previous_;             // of the frame before
};

}  // namespace depth_fusion
