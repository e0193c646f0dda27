// ICP tracking: the pose of every frame against the model view, over tf2 and as messages.
#include <pluginlib/class_list_macros.hpp>

#include "ros/in_process/deferred.h"
#include "ros/in_process/live_tracker.h"
#include "ros/in_process/worker.h"
#include "ros/input/initial_pose.h"
#include "ros/input/rgbd_subscriber.h"
#include "ros/nodelets/icp_tracking_nodelet_parameters.h"
#include "ros/nodelets/stage_nodelet.h"
#include "ros/output/pose_publisher.h"
#include "ros/output/robot_sensors.h"
#include "ros/output/tracker_report.h"

namespace depth_fusion {

using WaitingFrame = Deferred<TexturedSensorFrame>;

class IcpTrackingNodelet : public StageNodelet {
 public:
  ~IcpTrackingNodelet() override;

 private:
  void start() override;
  void applyParameters() override;
  void betweenFrames(const std::function<void()>& action) override { worker_->between(action); }
  void subscribe();
  void process(const WaitingFrame& waiting);
  void publish(const SensorFrame& frame, const LiveResult& result, StageTimers& timers);
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) override;
  IcpTrackingNodeletParameters parameters_;
  ros::Subscriber frame_subscriber_, view_subscriber_;
  std::unique_ptr<PosePublisher> pose_publisher_;
  std::unique_ptr<RobotSensors> sensors_;
  std::unique_ptr<TrackerReport> report_;
  std::unique_ptr<LiveTracker> tracker_;
  std::unique_ptr<Worker<WaitingFrame>> worker_;
  std::unique_ptr<InitialPose> initial_pose_;
  std::unique_ptr<RgbdSubscriber> sensor_subscriber_;  // without texture odometry
};

IcpTrackingNodelet::~IcpTrackingNodelet() {
  stopServing();
  frame_subscriber_.shutdown();
  view_subscriber_.shutdown();
  initial_pose_.reset();
  if (tracker_ != nullptr) tracker_->fusion().stop();
  if (worker_ != nullptr) worker_->stop();
  sensor_subscriber_.reset();
}

void IcpTrackingNodelet::start() {
  loadParameters(parameters_.table(), parameters_.stages());
  ros::NodeHandle& private_handle = getMTPrivateNodeHandle();
  pose_publisher_ = std::make_unique<PosePublisher>(getMTNodeHandle(), private_handle, parameters_.pose);
  sensors_ = std::make_unique<RobotSensors>(getMTNodeHandle(), pose_publisher_->transforms());
  report_ = std::make_unique<TrackerReport>(private_handle.advertise<TrackerStatus>("status", 100, true));
  tracker_ = std::make_unique<LiveTracker>(
      parameters_.tracker, private_handle.advertise<TrackedFrameMessage>("frame", kProcessQueue),
      LiveTracker::Robot{
          [this](const auto& camera, const auto& up) { return pose_publisher_->startPose(camera, up); },
          [this] { pose_publisher_->reset(); },
          [this](const Corrections& corrections) { pose_publisher_->correct(corrections); },
          [this](const auto& camera, double stamp_s) { return sensors_->until(camera, stamp_s); }});
  worker_ = std::make_unique<Worker<WaitingFrame>>(
      parameters_.queue_size, [this](const WaitingFrame& frame) { process(frame); },
      [this](const WaitingFrame& frame) {
        counter_.drop(kTooSlow);
        if (frame.ready() != nullptr) tracker_->skip(*frame.ready());
      });
  subscribe();
  startReporting();
}

void IcpTrackingNodelet::subscribe() {
  view_subscriber_ = subscribeInProcess<MapView>(
      "tsdf_fusion/model_view", "tsdf_fusion", Carries::kOther,
      [this](const MapViewMessage::ConstPtr& view) { tracker_->fusion().receive(view); });
  initial_pose_ =
      std::make_unique<InitialPose>(getMTNodeHandle(), parameters_.pose.map_frame,
                                    [this](const Pose& T_map_base) { tracker_->expectAt(T_map_base); });
  if (parameters_.tracker.use_texture) {
    frame_subscriber_ = subscribeInProcess<TexturedSensorFrame>(
        "texture_odometry/frame", "texture_odometry", Carries::kFrames,
        [this](const TexturedFrameMessage::ConstPtr& message) { worker_->push(message->payload); });
    return;
  }
  // The worker's thread makes it, so that no frame is at work before it is there.
  worker_->between([this] {
    const auto take = [this](const RgbdMessagesPtr& messages) {
      worker_->push(
          WaitingFrame([this, messages] { return withoutTexture(sensor_subscriber_->decode(*messages)); }));
    };
    sensor_subscriber_ = std::make_unique<RgbdSubscriber>(getMTNodeHandle(), parameters_.rgbd,
                                                          parameters_.tracker.device, counter_, take);
  });
}

void IcpTrackingNodelet::applyParameters() {
  const PipelineParameters& pipeline = parameters_.tracker.pipeline;
  validateRange(pipeline.preprocessing, pipeline.depth_sensor);
  parameters_.rgbd.checkTexts();
  if (tracker_ != nullptr) tracker_->applyParameters();
  if (sensor_subscriber_ != nullptr) sensor_subscriber_->setParameters(parameters_.rgbd);
}

void IcpTrackingNodelet::process(const WaitingFrame& waiting) {
  StageTimers timers;
  TexturedFramePtr frame;
  LiveResult result;
  try {
    tracker_->conclude();
    frame = worker_->nextIfFull(waiting).value_or(waiting).take();
    if (frame != nullptr) result = tracker_->track(*frame, timers);
  } catch (const std::exception& error) {
    NODELET_ERROR_STREAM_THROTTLE(5.0, getName() << ": " << error.what());
    result = tracker_->fail(error.what());
    if (frame == nullptr) frame = waiting.take();
  }
  if (frame == nullptr) return;
  publish(*frame->sensor, result, timers);
  if (result.tracking.status != TrackingStatus::kLost) tracker_->send(frame->sensor, result.tracking);
  recordTimings(timers);
}

void IcpTrackingNodelet::publish(const SensorFrame& frame, const LiveResult& result, StageTimers& timers) {
  TrackerStatus status = tracker_->statusOf(frame, result);
  const bool lost = result.tracking.status == TrackingStatus::kLost;
  if (lost) {
    counter_.drop(result.lost_for);
    pose_publisher_->publishLost(frame.header, result.tracking.bridged,
                                 (result.lost_for == kLost ? "LOST: " : "") + result.tracking.reason);
  } else {
    counter_.process();
    pose_publisher_->publish(frame.header, result.tracking);
    timers.record("icp_tracking/latency", 1e3 * status.latency_s);
  }
  status.frames = counter_.account();
  report_->publish(status, lost && result.lost_for == kLost, tracker_->deviceName());
}

void IcpTrackingNodelet::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  report_->diagnose(sensor_subscriber_ ? sensor_subscriber_->problem() : "", status);
  pose_publisher_->diagnose(status);
  status.add("queue", worker_->waiting());
}

}  // namespace depth_fusion

PLUGINLIB_EXPORT_CLASS(depth_fusion::IcpTrackingNodelet, nodelet::Nodelet)
