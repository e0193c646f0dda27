#include "ros/in_process/frame_mapper.h"

#include <ros/console.h>

#include "depth_fusion/pipeline/stored_map.h"

namespace depth_fusion {
namespace {

const std::string kEmptied =
    "the map was emptied, for the clock went back; on_clock_jump: keep would have kept it";

}  // namespace

void FrameMapper::setParameters(const PipelineParameters& parameters) {
  parameters_ = parameters;
  if (preprocessor_ != nullptr)
    preprocessor_->setParameters(parameters.preprocessing, parameters.depth_sensor);
}

MappingOutcome FrameMapper::map(const TrackedFrame& frame, FusedMap& map, bool resets_on_jump,
                                StageTimers& timers) {
  prepare(frame.sensor->rgbd.intrinsics);
  const MapState state{map.map().generation(), map.isEmpty()};
  const Admission admission = admission_.admit(frame, state, resets_on_jump);
  if (!admission.fuse) return {admission.may_predict_from, false, admission.reason};
  if (admission.begins == Beginning::kMap) empty(map);
  if (admission.begins == Beginning::kPart && !map.submaps().beginPart())
    return {false, false, map.submaps().problem()};
  MappingOutcome outcome = fuse(frame, map, timers);
  if (admission.begins == Beginning::kNone || state.is_empty) return outcome;
  const std::string& why = frame.tracking.reason.empty() ? kEmptied : frame.tracking.reason;
  outcome.reason = why + (outcome.reason.empty() ? "" : "; " + outcome.reason);
  ROS_WARN_STREAM(outcome.reason);
  return outcome;
}

void FrameMapper::prepare(const CameraIntrinsics& camera) {
  if (sameCamera(camera, camera_)) return;
  camera_ = camera;
  view_.reset();
  motion_ = MotionModel();
  preprocessor_.reset();
}

MappingOutcome FrameMapper::fuse(const TrackedFrame& frame, FusedMap& map, StageTimers& timers) {
  const RgbdFrame& rgbd = frame.sensor->rgbd;
  const Pose& T_W_D = frame.tracking.T_W_D;
  if (frame.depth == nullptr && preprocessor_ == nullptr)
    preprocessor_ = std::make_unique<DepthPreprocessor>(*compute_, parameters_.preprocessing, camera_,
                                                        parameters_.depth_sensor);
  if (frame.depth == nullptr) preprocessor_->process(rgbd, motion_.moveTo(rgbd.stamp_s, T_W_D), timers);
  const std::shared_ptr<const DepthFrame> depth = frame.depth ? frame.depth : preprocessor_->result();
  map.noteFrame(rgbd.stamp_s, T_W_D.translation());
  const MappingResult result = map.mapper(camera_).fuse(rgbd, *depth, T_W_D, admission_.isExternal(), timers);
  if (!result.fusion.fused()) return {false, false, notFusedReason()};
  last_pose_ = {rgbd.stamp_s, T_W_D};
  map.tell(depth, T_W_D);
  const std::string problem = map.submaps().problem();
  return {true, true, problem.empty() ? leftOutReason(result) : problem,
          result.fusion.blocks_requested - result.fusion.blocks_allocated};
}

void FrameMapper::render(const TrackedFrame& frame, FusedMap& map, StageTimers& timers) {
  Mapper& mapper = map.mapper(camera_);
  mapper.render(frame.tracking.T_W_D, timers);
  view_ = mapper.renderer().view();
}

void FrameMapper::load(FusedMap& map, ReadMap& stored, const std::string& name, const MapReset& reset) {
  const MapDescription& description = stored.loaded().description;
  map.load(stored, name);
  admission_.noteReset(reset);
  move_.reset();
  last_pose_ = description.last_pose;
  prepare(description.camera);
  renderLast(map);
}

void FrameMapper::replace(FusedMap& map, ReadMap& refined, const std::string& name,
                          const Corrections& corrections) {
  MapMove move{map.map().generation(), std::make_shared<const Corrections>(corrections),
               corrections.largestMove_m()};
  map.replace(refined, name);
  const Pose T_W_last = corrections.corrected(last_pose_);
  move.jump_m = (T_W_last.translation() - last_pose_.T_W_D.translation()).norm();
  move_ = std::make_shared<const MapMove>(std::move(move));
  last_pose_.T_W_D = T_W_last;
  map.noteFrame(last_pose_.stamp_s, T_W_last.translation());
  renderLast(map);
}

void FrameMapper::renderLast(FusedMap& map) {
  Mapper& mapper = map.mapper(camera_);
  StageTimers timers;
  mapper.render(last_pose_.T_W_D, timers);
  view_ = mapper.renderer().view();
}

MapDescription FrameMapper::describe(FusedMap& map) const {
  PipelineParameters parameters = parameters_;
  parameters.map = map.map().parameters();
  return descriptionOf(parameters, camera_, last_pose_);
}

void FrameMapper::reset(FusedMap& map, const MapReset& reset) {
  empty(map);
  admission_.noteReset(reset);
}

void FrameMapper::empty(FusedMap& map) {
  map.reset();
  view_.reset();
  move_.reset();
}

}  // namespace depth_fusion
