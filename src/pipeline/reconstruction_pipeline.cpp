#include "depth_fusion/pipeline/reconstruction_pipeline.h"

namespace depth_fusion {

ReconstructionPipeline::ReconstructionPipeline(ComputeContext& compute, const PipelineParameters& parameters,
                                               const CameraIntrinsics& camera)
    : compute_(compute),
      parameters_(withinSensorRange(parameters)),
      map_(compute, parameters.map),
      odometry_(parameters.texture_odometry),
      mapper_(compute, map_, parameters, camera),
      tracker_(compute, parameters, camera,
               [this](const Pose& T_W_D) -> const ModelView& { return mapper_.render(T_W_D, timers_); }) {
  parameters_.map = map_.parameters();
}

FrameResult ReconstructionPipeline::processFrame(const RgbdFrame& frame, const RgbdFrame* next) {
  const StageTimers::Scope timer(timers_, "frame");
  FrameResult result;
  const TexturedFrame textured = next_.valid() ? next_.get() : findMotion(frame);
  if (next != nullptr)
    next_ = std::async(std::launch::async, [this, after = *next] { return findMotion(after); });
  if (parameters_.texture_odometry.enabled) timers_.record("texture_odometry", textured.milliseconds);
  result.tracking = tracker_.track(frame, textured.motion, textured.features, view_, timers_);
  if (result.tracking.status != TrackingStatus::kLost) fuse(frame, *tracker_.depth(), result);
  if (result.tracking.status == TrackingStatus::kLost) {
    tracker_.reject();
    return result;
  }
  tracker_.accept(frame, textured.features, result.tracking.T_W_D);
  view_ = &mapper_.render(result.tracking.T_W_D, timers_);
  return result;
}

FrameResult ReconstructionPipeline::processFrame(const RgbdFrame& frame, const Pose& T_W_D) {
  const StageTimers::Scope timer(timers_, "frame");
  FrameResult result;
  result.tracking.status = TrackingStatus::kTracking;
  result.tracking.T_W_D = T_W_D;
  if (!posed_preprocessor_)
    posed_preprocessor_ = std::make_unique<PosedPreprocessor>(compute_, parameters_, frame.intrinsics);
  fuse(frame, posed_preprocessor_->process(frame, T_W_D, timers_), result);
  return result;
}

ReconstructionPipeline::TexturedFrame ReconstructionPipeline::findMotion(const RgbdFrame& frame) {
  TexturedFrame textured;
  if (!parameters_.texture_odometry.enabled) {
    textured.motion.reason = textured.features.reason = "texture_odometry/enabled is false";
    return textured;
  }
  StageTimers timers;
  {
    const StageTimers::Scope timer(timers, "texture_odometry");
    textured.motion = odometry_.process(frame);
    textured.features = odometry_.previous();
  }
  textured.milliseconds = timers.samplesMs().begin()->second.front();
  return textured;
}

void ReconstructionPipeline::fuse(const RgbdFrame& frame, const DepthFrame& depth, FrameResult& result) {
  const MappingResult mapping = mapper_.fuse(frame, depth, result.tracking.T_W_D, timers_);
  result.fusion = mapping.fusion;
  result.color = mapping.color;
  if (mapping.fused()) return;
  result.tracking.status = TrackingStatus::kLost;
  result.tracking.reason = notFusedReason();
}

}  // namespace depth_fusion
