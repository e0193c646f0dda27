#include "depth_fusion/pipeline/reconstruction_pipeline.h"

namespace depth_fusion {

ReconstructionPipeline::ReconstructionPipeline(ComputeContext& compute, const PipelineParameters& parameters,
                                               const CameraIntrinsics& camera)
    : parameters_(withinSensorRange(parameters)),
      map_(compute, parameters.map),
      odometry_(parameters.texture_odometry, parameters.depth_sensor),
      mapper_(compute, map_, parameters, camera),
      tracking_queue_(compute.anotherQueue()),
      tracker_(*tracking_queue_, parameters, camera,
               [this](const Pose& T_W_D) -> const ModelView& { return mapper_.render(T_W_D, timers_); }) {
  parameters_.map = map_.parameters();
}

FrameResult ReconstructionPipeline::processFrame(const RgbdFrame& frame, const RgbdFrame* next) {
  const StageTimers::Scope timer(timers_, "frame");
  const PreparedFrame prepared = prepared_.valid() ? prepared_.get() : prepare(frame);
  timers_.append(prepared.timers);
  if (next != nullptr)
    textured_ = std::async(std::launch::async, [this, after = *next] { return findMotion(after); });
  FrameResult result;
  result.tracking = tracker_.track(frame, prepared.prior, prepared.features, view_, timers_);
  const std::shared_ptr<const DepthFrame> depth = tracker_.depth();
  const bool tracked = result.tracking.status != TrackingStatus::kLost;
  if (tracked) {
    tracker_.accept(frame, prepared.features, result.tracking.T_W_D);
  } else {
    tracker_.reject();
  }
  if (next != nullptr)
    prepared_ = std::async(std::launch::async, [this, after = *next] { return prepare(after); });
  if (tracked) {
    fuse(frame, *depth, result);
    if (result.fusion.fused()) view_ = &mapper_.render(result.tracking.T_W_D, timers_);
  }
  if (next != nullptr) prepared_.wait();
  if (tracked && !result.fusion.fused()) withdraw();
  return result;
}

FrameResult ReconstructionPipeline::processFrame(const RgbdFrame& frame, const Pose& T_W_D) {
  const StageTimers::Scope timer(timers_, "frame");
  FrameResult result;
  result.tracking.status = TrackingStatus::kTracking;
  result.tracking.T_W_D = T_W_D;
  tracker_.follow(frame, T_W_D, timers_);
  fuse(frame, *tracker_.depth(), result);
  return result;
}

void ReconstructionPipeline::withdraw() {
  if (view_ == nullptr) {
    tracker_.reset();
  } else {
    tracker_.reject();
  }
}

ReconstructionPipeline::TexturedFrame ReconstructionPipeline::findMotion(const RgbdFrame& frame) {
  TexturedFrame textured;
  if (!parameters_.texture_odometry.enabled) {
    textured.motion.reason = textured.features.reason = "texture_odometry/enabled is false";
    return textured;
  }
  {
    const StageTimers::Scope timer(textured.timers, "texture_odometry");
    textured.motion = odometry_.process(frame);
  }
  textured.features = odometry_.previous();
  return textured;
}

ReconstructionPipeline::PreparedFrame ReconstructionPipeline::prepare(const RgbdFrame& frame) {
  PreparedFrame prepared{textured_.valid() ? textured_.get() : findMotion(frame), {}};
  prepared.prior = tracker_.prepare(frame, prepared.motion, prepared.timers);
  return prepared;
}

void ReconstructionPipeline::fuse(const RgbdFrame& frame, const DepthFrame& depth, FrameResult& result) {
  const MappingResult mapping = mapper_.fuse(frame, depth, result.tracking.T_W_D, timers_);
  result.fusion = mapping.fusion;
  result.color = mapping.color;
  if (mapping.fusion.fused()) return;
  result.tracking.status = TrackingStatus::kLost;
  result.tracking.reason = notFusedReason();
}

}  // namespace depth_fusion
