#include "depth_fusion/pipeline/reconstruction_pipeline.h"

namespace depth_fusion {

ReconstructionPipeline::ReconstructionPipeline(ComputeContext& compute, const PipelineParameters& parameters,
                                               const CameraIntrinsics& camera)
    : parameters_(withinSensorRange(parameters)),
      map_(compute, parameters.map),
      odometry_(parameters.texture_odometry),
      mapper_(compute, map_, parameters, camera),
      tracker_(compute, parameters, camera,
               [this](const Pose& T_W_D) -> const ModelView& { return mapper_.render(T_W_D, timers_); }) {
  parameters_.map = map_.parameters();
}

FrameResult ReconstructionPipeline::processFrame(const RgbdFrame& frame) {
  const StageTimers::Scope timer(timers_, "frame");
  FrameResult result;
  const TextureOdometryResult motion = textureMotion(frame);
  result.tracking = tracker_.track(frame, motion, odometry_.previous(), view_, timers_);
  if (result.tracking.status != TrackingStatus::kLost) fuse(frame, result);
  if (result.tracking.status == TrackingStatus::kLost) {
    tracker_.reject();
    return result;
  }
  tracker_.accept(frame, odometry_.previous(), result.tracking.T_W_D);
  view_ = &mapper_.render(result.tracking.T_W_D, timers_);
  return result;
}

FrameResult ReconstructionPipeline::processFrame(const RgbdFrame& frame, const Pose& T_W_D) {
  const StageTimers::Scope timer(timers_, "frame");
  FrameResult result;
  result.tracking.status = TrackingStatus::kTracking;
  result.tracking.T_W_D = T_W_D;
  tracker_.follow(frame, T_W_D, timers_);
  fuse(frame, result);
  return result;
}

TextureOdometryResult ReconstructionPipeline::textureMotion(const RgbdFrame& frame) {
  if (!parameters_.texture_odometry.enabled) return {};
  const StageTimers::Scope timer(timers_, "texture_odometry");
  return odometry_.process(frame);
}

void ReconstructionPipeline::fuse(const RgbdFrame& frame, FrameResult& result) {
  const MappingResult mapping = mapper_.fuse(frame, *tracker_.depth(), result.tracking.T_W_D, timers_);
  result.fusion = mapping.fusion;
  result.color = mapping.color;
  if (mapping.fused()) return;
  result.tracking.status = TrackingStatus::kLost;
  result.tracking.reason = notFusedReason();
}

}  // namespace depth_fusion
