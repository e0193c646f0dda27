#include "depth_fusion/pipeline/reconstruction_pipeline.h"

#include <utility>

#include "depth_fusion/pipeline/stored_map.h"

namespace depth_fusion {

ReconstructionPipeline::ReconstructionPipeline(ComputeContext& compute, const PipelineParameters& parameters,
                                               const CameraIntrinsics& camera)
    : parameters_(parameters),
      camera_(camera),
      map_(compute, parameters.map),
      submaps_(map_, parameters.submaps),
      odometry_(parameters.texture_odometry, parameters.depth_sensor),
      robot_(parameters.robot_motion),
      mapper_(compute, map_, submaps_, parameters, camera),
      tracking_queue_(compute.anotherQueue()),
      session_(*tracking_queue_, parameters, camera,
               [this](const Pose& T_W_D) -> const ModelView& { return mapper_.render(T_W_D, timers_); }),
      ahead_(odometry_, robot_, session_) {
  parameters_.map = map_.parameters();
}

FrameResult ReconstructionPipeline::processFrame(const RgbdFrame& frame, const RgbdFrame* next) {
  const StageTimers::Scope timer(timers_, "frame");
  FrameResult result;
  TexturedFrame texture = ahead_.textureOf(frame, timers_);
  ahead_.announce(next);
  if (session_.givesUpMap()) beginAnew();
  if (loops_ && session_.isLostForLong()) beginPart();
  const Pose start = startPose(texture.robot.attitude);
  result.tracking = session_.step(frame, std::move(texture), view_, timers_, start);
  if (result.tracking.status != TrackingStatus::kLost) robot_.learn(frame.stamp_s, result.tracking.T_W_D);
  ahead_.prepare();
  fuseAndRender(frame, result);
  ahead_.wait();
  if (loops_ && result.fusion.fused()) loops_->add(frame, session_.features(), result.tracking.T_W_D, *view_);
  session_.conclude(result.fusion.fused(), parameters_.map.color ? &frame : nullptr);
  return result;
}

FrameResult ReconstructionPipeline::processFrame(const RgbdFrame& frame, const Pose& T_W_D) {
  const StageTimers::Scope timer(timers_, "frame");
  FrameResult result;
  ahead_.checkNoneAnnounced();
  session_.follow(frame, T_W_D, timers_);
  result.tracking.status = TrackingStatus::kTracking;
  result.tracking.T_W_D = T_W_D;
  result.tracking.map_doubt = session_.mapDoubt();
  fuse(frame, result, true);
  return result;
}

void ReconstructionPipeline::closeLoops() { loops_ = std::make_unique<LoopClosing>(parameters_.loops); }

void ReconstructionPipeline::setKeyframes(Keyframes keyframes) {
  session_.reset(last_pose_.T_W_D, std::move(keyframes));
}

LoadedMap ReconstructionPipeline::load(Database& stored) {
  ahead_.checkNoneAnnounced();
  ReadMap read(stored, submaps_);
  checkFilterRule(read.loaded().description, parameters_, stored.name());
  read.moveTo(submaps_);
  last_pose_ = read.loaded().description.last_pose;
  session_.reset(last_pose_.T_W_D, read.loaded().keyframes);
  view_ = &mapper_.render(last_pose_.T_W_D, timers_);
  return read.loaded();
}

SaveReport ReconstructionPipeline::save(MapSaver& saver) {
  saver.prepare();
  saver.capture(submaps_, descriptionOf(parameters_, camera_, last_pose_), session_.keyframes());
  return saver.write();
}

void ReconstructionPipeline::beginAnew() {
  session_.beginAnew();
  if (loops_) loops_->beginAnew();
  map_.reset(Eigen::Vector3d::Zero());
  view_ = nullptr;
}

void ReconstructionPipeline::beginPart() {
  if (!submaps_.beginPart()) return;
  session_.beginPart();
  loops_->beginAnew();
  view_ = nullptr;
}

void ReconstructionPipeline::fuseAndRender(const RgbdFrame& frame, FrameResult& result) {
  try {
    fuse(frame, result);
    if (result.fusion.fused()) view_ = &mapper_.render(result.tracking.T_W_D, timers_);
  } catch (...) {
    ahead_.wait();
    session_.lose();
    throw;
  }
}

void ReconstructionPipeline::fuse(const RgbdFrame& frame, FrameResult& result, bool is_given) {
  if (result.tracking.status == TrackingStatus::kLost) return;
  const MappingResult mapping =
      mapper_.fuse(frame, *session_.depth(), result.tracking.T_W_D, is_given, timers_);
  result.fusion = mapping.fusion;
  result.color = mapping.color;
  if (mapping.fusion.fused()) {
    last_pose_ = {frame.stamp_s, result.tracking.T_W_D};
    return;
  }
  result.tracking.status = TrackingStatus::kLost;
  result.tracking.reason = notFusedReason();
}

}  // namespace depth_fusion
