// ICP tracking: the pose of every frame against the model view, over tf2 and as messages.
#include <pluginlib/class_list_macros.hpp>

#include "depth_fusion/pipeline/frame_tracker.h"
#include "ros/conversions/status_messages.h"
#include "ros/in_process/fusion_link.h"
#include "ros/in_process/shared_map.h"
#include "ros/in_process/skipped_frames.h"
#include "ros/in_process/worker.h"
#include "ros/input/rgbd_subscriber.h"
#include "ros/nodelets/stage_nodelet.h"
#include "ros/output/pose_publisher.h"

namespace depth_fusion {

constexpr char kLost[] = "lost", kPaused[] = "paused";

class IcpTrackingNodelet : public StageNodelet {
 public:
  ~IcpTrackingNodelet() override;

 private:
  void start() override;
  void loadAll();
  void applyParameters() override;
  void betweenFrames(const std::function<void()>& action) override { worker_->between(action); }
  void subscribe();

  // In the worker's thread:
  void process(const TexturedFramePtr& waiting);
  void prepare(const TexturedFrame& frame);
  void makeTracker(const CameraIntrinsics& camera);
  void apply(const FusionNews& news);
  // A clock set back, a map that is gone, frames skipped before this one.
  void catchUp(const SensorFrame& frame);
  // Why a frame is not to be tracked at all, or nothing.
  std::string refusal(const SensorFrame& frame) const;
  TrackingResult track(const TexturedFramePtr& frame, StageTimers& timers);
  // `lost_for`: what a lost frame is counted as.
  void publish(const TexturedFrame& frame, const TrackingResult& result, const std::string& lost_for,
               StageTimers& timers);
  void forgetMap();
  // Of the last fused frame; null if there is nothing to be seen yet.
  const ModelView* view() const { return map_ == nullptr ? nullptr : map_->view.get(); }
  // Of the map from anywhere, for relocalisation.
  const ModelView& render(const Pose& T_W_D);

  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) override;

  PipelineParameters parameters_;
  RgbdParameters rgbd_;
  PoseParameters pose_;
  std::string device_, on_clock_jump_ = "reset";
  bool use_texture_ = true;
  int queue_size_ = 1;

  std::shared_ptr<ComputeContext> compute_;
  std::unique_ptr<FrameTracker> tracker_;
  CameraIntrinsics camera_;
  std::shared_ptr<const TextureOdometryParameters> texture_;  // as last seen
  std::shared_ptr<const MapView> map_;         // what fusion last showed of it; null: nothing yet
  std::shared_ptr<const ModelView> rendered_;  // what render() returned last, while a frame is tracked
  uint32_t clock_jumps_ = 0;

  SkippedFrames skipped_;

  std::mutex status_mutex_;
  TrackerStatus status_;
  bool is_in_map_ = true;  // unless nothing fits
  std::string device_name_;

  ros::Publisher status_publisher_;
  ros::Subscriber frame_subscriber_, view_subscriber_;
  std::unique_ptr<FusionLink> fusion_;
  std::unique_ptr<PosePublisher> pose_publisher_;
  std::unique_ptr<Worker<TexturedFramePtr>> worker_;
  std::unique_ptr<RgbdSubscriber> sensor_subscriber_;  // without texture odometry
};

IcpTrackingNodelet::~IcpTrackingNodelet() {
  stopReporting();
  frame_subscriber_.shutdown();
  view_subscriber_.shutdown();
  sensor_subscriber_.reset();
  if (fusion_ != nullptr) fusion_->stop();
  if (worker_ != nullptr) worker_->stop();
}

void IcpTrackingNodelet::start() {
  loadAll();
  ros::NodeHandle& handle = getMTNodeHandle();
  ros::NodeHandle& private_handle = getMTPrivateNodeHandle();
  pose_publisher_ = std::make_unique<PosePublisher>(handle, private_handle, pose_);
  fusion_ =
      std::make_unique<FusionLink>(private_handle.advertise<TrackedFrameMessage>("frame", kProcessQueue));
  status_publisher_ = private_handle.advertise<TrackerStatus>("status", 100, true);
  worker_ = std::make_unique<Worker<TexturedFramePtr>>(
      queue_size_, [this](const TexturedFramePtr& frame) { process(frame); },
      [this](const TexturedFramePtr& frame) {
        counter_.drop(kTooSlow);
        skipped_.add(*frame);
      });
  subscribe();
  startReporting();
}

void IcpTrackingNodelet::subscribe() {
  view_subscriber_ =
      subscribeInProcess<MapView>("tsdf_fusion/model_view", "tsdf_fusion", Carries::kOther,
                                  [this](const MapViewMessage::ConstPtr& view) { fusion_->receive(view); });
  if (use_texture_) {
    frame_subscriber_ = subscribeInProcess<TexturedFrame>(
        "texture_odometry/frame", "texture_odometry", Carries::kFrames,
        [this](const TexturedFrameMessage::ConstPtr& message) { worker_->push(message->payload); });
    return;
  }
  sensor_subscriber_ = std::make_unique<RgbdSubscriber>(
      getMTNodeHandle(), rgbd_, device_, counter_, [this](const SensorFramePtr& sensor) {
        auto frame = std::make_shared<TexturedFrame>();
        frame->sensor = sensor;
        frame->motion.reason = frame->features.reason = "no texture odometry";
        worker_->push(frame);
      });
}

void IcpTrackingNodelet::loadAll() {
  ParameterTable table = parameters_.icp_tracking.table();
  for (const ParameterTable& rows : {rgbd_.table(), pose_.table()})
    table.insert(table.end(), rows.begin(), rows.end());
  table.push_back(deviceRow(device_));
  table.push_back(
      {"texture_odometry",
       &use_texture_,
       0,
       1,
       "true: frames come from texture_odometry; false: from the topics, with the last pose as the prior",
       {},
       true});
  table.push_back(queueSizeRow(queue_size_));
  table.push_back(
      {"on_clock_jump",
       &on_clock_jump_,
       0,
       0,
       "what a clock that goes back does to the map: begin anew, or keep it and find the sensor in it",
       {"reset", "keep"}});
  loadParameters(table, {{"registration", rgbd_.registration.table()},
                         {"depth_sensor", parameters_.depth_sensor.table()},
                         {"preprocessing", parameters_.preprocessing.table()},
                         {"relocalisation", parameters_.relocalisation.table()}});
}

void IcpTrackingNodelet::applyParameters() {
  validateRange(parameters_.preprocessing, parameters_.depth_sensor);
  if (tracker_ != nullptr) tracker_->setParameters(parameters_);
  if (sensor_subscriber_ != nullptr) sensor_subscriber_->setParameters(rgbd_);
}

void IcpTrackingNodelet::process(const TexturedFramePtr& waiting) {
  StageTimers timers;
  TexturedFramePtr frame = waiting;
  TrackingResult result;
  std::string lost_for = kLost;
  try {
    if (tracker_ == nullptr) prepare(*frame);
    for (const FusionNews& news : fusion_->await()) apply(news);
    frame = worker_->nextIfFull(frame);
    prepare(*frame);
    catchUp(*frame->sensor);
    result.reason = refusal(*frame->sensor);
    if (result.reason.empty()) {
      result = track(frame, timers);
    } else {
      lost_for = result.reason;
      tracker_->reject();
    }
  } catch (const std::exception& error) {
    NODELET_ERROR_STREAM_THROTTLE(5.0, getName() << ": " << error.what());
    result = TrackingResult();
    result.reason = error.what();
    lost_for = "error";
    if (tracker_ != nullptr) tracker_->reject();
  }
  publish(*frame, result, lost_for, timers);
  if (result.status != TrackingStatus::kLost) fusion_->send(frame, tracker_->depth(), result);
  recordTimings(timers);
}

std::string IcpTrackingNodelet::refusal(const SensorFrame& frame) const {
  if (!fusion_->connected()) return "no map to track against; load tsdf_fusion in the same nodelet manager";
  if (fusion_->mode() == MapMode::kPaused) return kPaused;
  return fusion_->isBeforeReset(frame) ? kBeforeReset : "";
}

void IcpTrackingNodelet::prepare(const TexturedFrame& frame) {
  if (frame.parameters != nullptr && frame.parameters != texture_) {
    texture_ = frame.parameters;
    parameters_.texture_odometry = *texture_;
    if (tracker_ != nullptr) tracker_->setParameters(parameters_);
  }
  const CameraIntrinsics& camera = frame.sensor->rgbd.intrinsics;
  if (tracker_ == nullptr || !sameCamera(camera, camera_)) makeTracker(camera);
}

void IcpTrackingNodelet::makeTracker(const CameraIntrinsics& camera) {
  if (tracker_ != nullptr)
    NODELET_WARN("the camera's intrinsics have changed; the sensor is searched for in the map");
  compute_ = sharedCompute(device_);
  NODELET_INFO_STREAM("OpenCL device: " << compute_->selfTestReport());
  tracker_ =
      std::make_unique<FrameTracker>(*compute_, parameters_, camera,
                                     [this](const Pose& T_W_D) -> const ModelView& { return render(T_W_D); });
  camera_ = camera;
  if (view() != nullptr) tracker_->expectAt(view()->T_W_D);
  const std::lock_guard<std::mutex> lock(status_mutex_);
  device_name_ = compute_->device().name;
}

void IcpTrackingNodelet::apply(const FusionNews& news) {
  switch (news.kind) {
    case FusionNews::kAccepted:
      map_ = news.view;
      return tracker_->accept(news.frame->sensor->rgbd, news.frame->features, news.T_W_D);
    case FusionNews::kRejected:
      if (news.view == nullptr)
        NODELET_ERROR("no answer from tsdf_fusion to the last frame, which counts as lost");
      return tracker_->reject();
    case FusionNews::kOtherMap:
      forgetMap();
      map_ = news.view;
      if (view() != nullptr) tracker_->expectAt(view()->T_W_D);
  }
}

void IcpTrackingNodelet::catchUp(const SensorFrame& frame) {
  if (frame.clock_jumps != std::exchange(clock_jumps_, frame.clock_jumps)) {
    tracker_->reject();
    if (on_clock_jump_ == "reset" && fusion_->mode() == MapMode::kMapping) {
      forgetMap();
      fusion_->beginMap();
    }
  }
  if (map_ != nullptr && map_->map.expired()) forgetMap();  // tsdf_fusion was unloaded
  skipped_.replay(frame, *tracker_);
}

void IcpTrackingNodelet::forgetMap() {
  tracker_->reset();
  pose_publisher_->reset();
  map_.reset();
}

TrackingResult IcpTrackingNodelet::track(const TexturedFramePtr& frame, StageTimers& timers) {
  const Pose start = view() == nullptr ? pose_publisher_->startPose(frame->sensor->header) : Pose::Identity();
  const RgbdFrame& rgbd = frame->sensor->rgbd;
  const MotionPrior prior = tracker_->prepare(rgbd, frame->motion, timers);
  const TrackingResult result = tracker_->track(rgbd, prior, frame->features, view(), timers, start);
  if (result.status == TrackingStatus::kLost) tracker_->reject();
  rendered_.reset();
  return result;
}

void IcpTrackingNodelet::publish(const TexturedFrame& frame, const TrackingResult& result,
                                 const std::string& lost_for, StageTimers& timers) {
  const std_msgs::Header& header = frame.sensor->header;
  TrackerStatus status = makeTrackerStatus(header, result);
  if (result.status == TrackingStatus::kLost) {
    if (lost_for == kPaused) status.state = TrackerStatus::PAUSED;
    counter_.drop(lost_for);
    pose_publisher_->publishLost(header);
  } else {
    counter_.process();
    try {
      pose_publisher_->publish(header, result.T_W_D, result.covariance);
    } catch (const Error& error) {
      NODELET_WARN_STREAM_THROTTLE(5.0, getName() << ": no transform sent: " << error.what());
    }
    timers.record("icp_tracking/latency", 1e3 * status.latency_s);
  }
  status.prior = view() == nullptr ? "start" : frame.motion.found ? "texture" : "last pose";
  status.keyframes = tracker_ == nullptr ? 0 : static_cast<uint32_t>(tracker_->keyframeCount());
  status.frames = counter_.account();
  status_publisher_.publish(boost::make_shared<TrackerStatus>(status));
  const std::lock_guard<std::mutex> lock(status_mutex_);
  status_ = status;
  is_in_map_ = result.status != TrackingStatus::kLost || lost_for != kLost;
}

const ModelView& IcpTrackingNodelet::render(const Pose& T_W_D) {
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

void IcpTrackingNodelet::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const std::string problem = sensor_subscriber_ ? sensor_subscriber_->problem() : "";
  const std::lock_guard<std::mutex> lock(status_mutex_);
  depth_fusion::diagnose(status_, problem, is_in_map_ ? "" : "; move the sensor back to where it has been",
                         status);
  status.add("queue", worker_->waiting());
  status.add("device", device_name_);
}

}  // namespace depth_fusion

PLUGINLIB_EXPORT_CLASS(depth_fusion::IcpTrackingNodelet, nodelet::Nodelet)
