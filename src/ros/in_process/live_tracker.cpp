#include "ros/in_process/live_tracker.h"

#include <ros/console.h>

#include <utility>

#include "depth_fusion/common/error.h"
#include "depth_fusion/preprocessing/sensor_noise.h"
#include "ros/conversions/status_messages.h"

namespace depth_fusion {
namespace {

constexpr char kPaused[] = "paused";

}  // namespace

PipelineParameters LiveTracker::pipelineParameters() const {
  PipelineParameters parameters = parameters_.pipeline;
  if (texture_ != nullptr) parameters.texture_odometry = *texture_;
  return parameters;
}

void LiveTracker::applyParameters() {
  if (session_ != nullptr) session_->setParameters(pipelineParameters());
  robot_motion_.setParameters(parameters_.pipeline.robot_motion);
}

void LiveTracker::conclude() {
  for (const FusionNews& news : fusion_.await()) apply(news);
}

LiveResult LiveTracker::track(const TexturedSensorFrame& frame, StageTimers& timers) {
  readySession(frame);
  robot_motion_.add(robot_.readings(frame.sensor->header, frame.sensor->rgbd.stamp_s));
  catchUp(*frame.sensor);
  TexturedFrame texture = frame.texture;
  texture.robot = robot_motion_.knowledge(frame.sensor->rgbd.stamp_s);
  LiveResult result;
  result.tracking.reason = refusal(*frame.sensor);
  if (result.tracking.reason.empty()) {
    searchAtExpected();
    const Pose start = view() == nullptr
                           ? robot_.start_pose(frame.sensor->header, texture.robot.attitude.up_D)
                           : Pose::Identity();
    result.tracking = session_->step(frame.sensor->rgbd, std::move(texture), view(), timers, start);
    if (result.tracking.status != TrackingStatus::kLost)
      robot_motion_.learn(frame.sensor->rgbd.stamp_s, result.tracking.T_W_D);
    rendered_.reset();
    if (!noise_was_said_) warnOfNoise();
  } else {
    result.lost_for = result.tracking.reason;
    session_->lose();
    session_->skip(frame.sensor->rgbd.stamp_s, texture.measuredMotions());
  }
  return result;
}

void LiveTracker::expectAt(const Pose& T_map_base) {
  const std::lock_guard<std::mutex> lock(expected_mutex_);
  T_map_base_ = T_map_base;
}

void LiveTracker::searchAtExpected() {
  std::unique_lock<std::mutex> lock(expected_mutex_);
  const std::optional<Pose> T_map_base = std::exchange(T_map_base_, std::nullopt);
  lock.unlock();
  if (T_map_base)
    session_->searchAt(*T_map_base * robot_motion_.cameraOnBase().value_or(levelPose(kCameraUp)));
}

void LiveTracker::shareKeyframes() {
  const Keyframes& keyframes = session_->keyframes();
  const KeyframePtr last = keyframes.empty() ? nullptr : keyframes.back();
  if (last == last_shared_) return;
  last_shared_ = last;
  if (const std::shared_ptr<SharedMap> map = map_->map.lock())
    map->keepKeyframes(map_->map_generation, keyframes);
}

Keyframes LiveTracker::keyframesOf(const std::shared_ptr<const MapView>& view) const {
  const std::shared_ptr<SharedMap> map = view == nullptr ? nullptr : view->map.lock();
  return map == nullptr ? Keyframes() : map->keyframesOf(view->map_generation);
}

void LiveTracker::warnOfNoise() {
  const std::string remark =
      noiseRemark(parameters_.pipeline.depth_sensor, session_->depth()->levels[0].sensor);
  noise_was_said_ = !remark.empty();
  if (noise_was_said_) ROS_WARN("%s", remark.c_str());
}

LiveResult LiveTracker::fail(const std::string& error) {
  LiveResult result;
  result.tracking.reason = error;
  result.lost_for = "error";
  if (session_ != nullptr) session_->lose();
  return result;
}

void LiveTracker::send(const SensorFramePtr& frame, const TrackingResult& tracking) {
  sent_ = frame;
  fusion_.send(frame, session_->depth(), tracking);
}

TrackerStatus LiveTracker::statusOf(const SensorFrame& frame, const LiveResult& result) const {
  TrackerStatus status = makeTrackerStatus(frame.header, result.tracking);
  if (result.lost_for == kPaused) status.state = TrackerStatus::PAUSED;
  status.robot_problem = robot_motion_.problem();
  status.keyframes = session_ == nullptr ? 0 : static_cast<uint32_t>(session_->keyframes().size());
  return status;
}

void LiveTracker::readySession(const TexturedSensorFrame& frame) {
  if (frame.parameters != nullptr && frame.parameters != texture_) {
    texture_ = frame.parameters;
    applyParameters();
  }
  const CameraIntrinsics& camera = frame.sensor->rgbd.intrinsics;
  if (session_ == nullptr || !sameCamera(camera, camera_)) makeSession(camera);
}

void LiveTracker::makeSession(const CameraIntrinsics& camera) {
  if (session_ != nullptr)
    ROS_WARN("the camera's intrinsics have changed; the sensor is searched for in the map");
  compute_ = sharedCompute(parameters_.device);
  ROS_INFO_STREAM("OpenCL device: " << compute_->selfTestReport());
  session_ = std::make_unique<TrackingSession>(
      *compute_, pipelineParameters(), camera,
      [this](const Pose& T_W_D) -> const ModelView& { return render(T_W_D); });
  camera_ = camera;
  noise_was_said_ = false;
  session_->reset(viewPose(), keyframesOf(map_));
}

void LiveTracker::apply(const FusionNews& news) {
  switch (news.kind) {
    case FusionNews::kAccepted:
      map_ = news.view;
      seekLoops();
      session_->conclude(true, keepsPictures() ? &sent_->rgbd : nullptr);
      return shareKeyframes();
    case FusionNews::kUnanswered:
      ROS_ERROR("no answer from tsdf_fusion to the last frame, which counts as lost");
      return session_->conclude(false);
    case FusionNews::kRejected:
      return session_->conclude(false);
    case FusionNews::kOtherMap:
      return changeMap(news.view);
  }
}

void LiveTracker::catchUp(const SensorFrame& frame) {
  if (frame.clock_jumps != std::exchange(clock_jumps_, frame.clock_jumps)) {
    session_->lose();
    if (parameters_.resetsOnClockJump() && fusion_.mode() == MapMode::kMapping) {
      changeMap(nullptr);
      fusion_.begin(Beginning::kMap);
    }
  }
  if (map_ != nullptr && map_->map.expired()) changeMap(nullptr);  // tsdf_fusion was unloaded
  if (session_->givesUpMap() && fusion_.mode() == MapMode::kMapping) {
    session_->beginAnew();
    map_ = nullptr;
    fusion_.begin(Beginning::kMap);
  }
  if (session_->isLostForLong()) beginPart();
  skipped_.replay(frame, *session_, robot_motion_);
}

std::string LiveTracker::refusal(const SensorFrame& frame) const {
  if (!fusion_.connected()) return "no map to track against; load tsdf_fusion in the same nodelet manager";
  if (fusion_.mode() == MapMode::kPaused) return kPaused;
  return fusion_.isBeforeReset(frame) ? kBeforeReset : "";
}

LoopsOfMap LiveTracker::loops() const {
  const std::shared_ptr<SharedMap> map = map_ == nullptr ? nullptr : map_->map.lock();
  const bool may_seek = map != nullptr && fusion_.mode() == MapMode::kMapping;
  return may_seek ? map->loopsOf(map_->map_generation) : LoopsOfMap();
}

void LiveTracker::beginPart() {
  const LoopsOfMap loops_of_map = loops();
  if (loops_of_map.closing == nullptr) return;
  loops_of_map.closing->beginAnew();
  session_->beginPart();
  map_ = nullptr;
  fusion_.begin(Beginning::kPart);
}

bool LiveTracker::keepsPictures() const {
  const std::shared_ptr<SharedMap> map = map_->map.lock();
  return map != nullptr && map->has_color;
}

void LiveTracker::seekLoops() {
  const LoopsOfMap loops = this->loops();
  if (loops.closing == nullptr || view() == nullptr) return;
  loops.closing->add(sent_->rgbd, session_->features(), view()->T_W_D, *view(), loops.world);
}

void LiveTracker::changeMap(const std::shared_ptr<const MapView>& map) {
  const bool is_moved = map != nullptr && map->move != nullptr && map_ != nullptr &&
                        map->move->from_generation == map_->map_generation;
  map_ = map;
  if (session_ != nullptr) session_->reset(viewPose(), keyframesOf(map));  // one that is made later does so
  if (is_moved) {
    const Corrections& corrections = *map->move->corrections;
    robot_.correct_poses(corrections);
    if (session_ != nullptr && corrections.isApart()) {
      const std::vector<CorrectedKeyframe>& keyframes = corrections.keyframes();
      session_->standsApart(keyframes[keyframes.back().part].stamp_s);
    }
  } else {
    robot_.forget_poses();
  }
  const std::lock_guard<std::mutex> lock(expected_mutex_);
  T_map_base_.reset();
}

const ModelView& LiveTracker::render(const Pose& T_W_D) {
  const std::shared_ptr<SharedMap> map = map_->map.lock();
  check(map != nullptr, "the map is gone; load tsdf_fusion again");
  map->locked([&](FusedMap& fused) {
    StageTimers timers;
    Mapper& mapper = fused.mapper(camera_);
    mapper.render(T_W_D, timers);
    rendered_ = mapper.renderer().view();
  });
  return *rendered_;
}

}  // namespace depth_fusion
