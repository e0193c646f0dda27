// One frame's way through all the stages.
#pragma once

#include "depth_fusion/color_fusion/color_fusion.h"
#include "depth_fusion/icp_tracking/icp_tracker.h"
#include "depth_fusion/model_view/model_view.h"
#include "depth_fusion/relocalisation/relocaliser.h"
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
  RelocalisationParameters relocalisation;
  FusionParameters tsdf_fusion;
  ColorFusionParameters color_fusion;
  SurfaceMeshParameters surface_mesh;

  // The rows of all the stages, named "<stage>/<name>".
  ParameterTable table();
};

struct FrameResult {
  TrackingResult tracking;
  FusionResult fusion;  // all zero if the frame was not fused
  ColorFusionResult color;
};

// Tracks and fuses frame by frame. W is the first fused frame's camera frame, or that of the given
// poses.
class ReconstructionPipeline {
 public:
  ReconstructionPipeline(ComputeContext& compute, const PipelineParameters& parameters,
                         const CameraIntrinsics& camera);

  // A lost frame changes nothing in the map. It and those after it are tried against keyframes and against the last
  // pose, until one fits.
  FrameResult processFrame(const RgbdFrame& frame);

  // The same with a pose from elsewhere in place of tracking; lost only if there is no depth.
  FrameResult processFrame(const RgbdFrame& frame, const Pose& T_W_D);

  BlockSparseMap& map() { return map_; }
  StageTimers& timers() { return timers_; }
  const PipelineParameters& parameters() const { return parameters_; }
  size_t keyframeCount() const { return relocaliser_.keyframes().size(); }

 private:
  // The texture's motion since the frame before; the last pose without one. Updates the velocity.
  MotionPrior predict(const RgbdFrame& frame);
  const DepthFrame& preprocess(const RgbdFrame& frame);
  TrackingResult track(const RgbdFrame& frame, const DepthFrame& depth, const MotionPrior& prior);
  // The first pose, if the frame has enough depth for the next one to be tracked against.
  TrackingResult begin(const RgbdFrame& frame) const;
  // Against the model seen from where keyframes, or after a loss the prior, say that the sensor is. `lost` without one.
  TrackingResult relocalise(const DepthFrame& depth, const MotionPrior& prior, const TrackingResult& lost);
  TrackingResult trackFrom(const MotionPrior& prior, const DepthFrame& depth);
  // Lost if nothing could be fused.
  void fuse(const RgbdFrame& frame, const DepthFrame& depth, FrameResult& result);
  // Takes the frame's pose as the one that the next is predicted from.
  void follow(const RgbdFrame& frame, const Pose& T_W_D);
  const ModelView& render(const Pose& T_W_D);

  ComputeContext& compute_;
  PipelineParameters parameters_;
  StageTimers timers_;
  BlockSparseMap map_;
  DepthPreprocessor preprocessor_;
  TextureOdometry odometry_;
  IcpTracker tracker_;
  Relocaliser relocaliser_;
  TsdfFusion fusion_;
  std::unique_ptr<ColorFusion> color_fusion_;  // null without map/color
  ModelViewRenderer renderer_;
  const ModelView* view_ = nullptr;  // of the last fused frame; none before the first
  std::optional<StampedPose> tracked_;    // the frame before; none if that was lost
  Pose T_W_expected_ = Pose::Identity();  // the frame before: as tracked last, then as the texture moved on from there
  double stamp_s_ = 0.0;                  // of the frame before
  Vector6d velocity_ = Vector6d::Zero();  // of D in D, per second
};

}  // namespace depth_fusion
