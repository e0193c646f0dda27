// ICP tracking: the pose of every frame against the model view, over tf2 and as messages.
#include <depth_fusion/TrackerStatus.h>
#include <pluginlib/class_list_macros.hpp>

#include <condition_variable>
#include <deque>

#include "depth_fusion/pipeline/frame_tracker.h"
#include "ros/nodelets/pose_publisher.h"
#include "ros/nodelets/rgbd_subscriber.h"
#include "ros/nodelets/shared_map.h"
#include "ros/nodelets/stage_nodelet.h"
#include "ros/nodelets/worker.h"

namespace depth_fusion {
namespace {

// Stamps farther apart are not of the same clock.
constexpr double kSameClock_s = 10.0;
constexpr size_t kMaxViews = 8;

}  // namespace

using TexturedFramePtr = std::shared_ptr<const TexturedFrame>;

class IcpTrackingNodelet : public StageNodelet {
 public:
  ~IcpTrackingNodelet() override;

 private:
  struct Skipped {
    uint32_t clock_jumps;
    double stamp_s;
    TextureOdometryResult motion;
  };
  // Sent to fusion and not answered yet.
  struct Sent {
    TexturedFramePtr frame;
    TrackedFrame tracked;
  };

  void start() override;
  void loadAll();
  void applyParameters() override;
  void betweenFrames(const std::function<void()>& action) override { worker_->between(action); }
  void receive(const TexturedFramePtr& frame);
  void receiveView(const MapViewMessage::ConstPtr& view);

  // In the worker's thread:
  void process(const TexturedFramePtr& waiting);
  void prepare(const CameraIntrinsics& camera);
  // Fusion's answer to the last frame, and whatever else it had to say.
  void awaitAnswer();
  // A clock set back, frames skipped before this one.
  void catchUp(const SensorFrame& frame);
  void apply(const MapViewMessage& view);
  // Why a frame is not to be tracked at all, or nothing.
  std::string refusal(const ros::Time& stamp);
  TrackingResult track(const TexturedFramePtr& frame, StageTimers& timers);
  void send(const TexturedFramePtr& frame, const TrackingResult& result);
  void publish(const TexturedFrame& frame, const TrackingResult& result, StageTimers& timers);
  // Another map than before, with what was seen of it last.
  void startFrom(const MapView& view);
  void forgetMap();
  const ModelView& render(const Pose& T_W_D);

  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) override;

  PipelineParameters parameters_;
  RgbdParameters rgbd_;
  PoseParameters pose_;
  std::string device_, map_name_, on_clock_jump_ = "reset";
  bool use_texture_ = true;
  int queue_size_ = 1;

  std::shared_ptr<ComputeContext> compute_;
  std::unique_ptr<FrameTracker> tracker_;
  CameraIntrinsics camera_;
  std::shared_ptr<const ModelView> view_;
  // Of the map from anywhere, for relocalisation; made when first needed.
  std::shared_ptr<SharedMap> map_;
  std::unique_ptr<ModelViewRenderer> renderer_;
  std::optional<Sent> sent_;
  uint32_t map_generation_ = 0;  // 0: of no map yet
  uint32_t clock_jumps_ = 0;
  bool begins_map_ = false;
  MapMode mode_ = MapMode::kMapping;

  std::mutex mutex_;  // of what the callbacks leave for the worker, and of the status
  std::condition_variable changed_;
  bool stopping_ = false;
  std::deque<MapViewMessage::ConstPtr> views_;
  std::vector<Skipped> skipped_;
  ros::Time newest_stamp_;
  uint32_t newest_jumps_ = 0;
  ros::Time reset_stamp_;  // of the newest frame from before the last reset
  TrackerStatus status_;

  ros::Publisher frame_publisher_, status_publisher_;
  ros::Subscriber frame_subscriber_, view_subscriber_;
  std::unique_ptr<PosePublisher> pose_publisher_;
  std::unique_ptr<Worker<TexturedFramePtr>> worker_;
  std::unique_ptr<RgbdSubscriber> sensor_subscriber_;  // without texture odometry
};

IcpTrackingNodelet::~IcpTrackingNodelet() {
  stopReporting();
  frame_subscriber_.shutdown();
  view_subscriber_.shutdown();
  sensor_subscriber_.reset();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  worker_.reset();
}

void IcpTrackingNodelet::start() {
  loadAll();
  ros::NodeHandle& handle = getMTNodeHandle();
  ros::NodeHandle& private_handle = getMTPrivateNodeHandle();
  if (map_name_.empty()) map_name_ = handle.resolveName("tsdf_fusion");
  pose_publisher_ = std::make_unique<PosePublisher>(handle, private_handle, pose_);
  frame_publisher_ = private_handle.advertise<TrackedFrameMessage>("frame", 10);
  status_publisher_ = private_handle.advertise<TrackerStatus>("status", 100, true);
  worker_ = std::make_unique<Worker<TexturedFramePtr>>(
      queue_size_, [this](const TexturedFramePtr& frame) { process(frame); },
      [this](const TexturedFramePtr& frame) {
        counter_.drop("too slow");
        const std::lock_guard<std::mutex> lock(mutex_);
        skipped_.push_back({frame->sensor->clock_jumps, frame->sensor->rgbd.stamp_s, frame->motion});
      });
  view_subscriber_ = handle.subscribe<MapViewMessage>("tsdf_fusion/model_view", 100,
                                                      &IcpTrackingNodelet::receiveView, this);
  if (use_texture_) {
    frame_subscriber_ = handle.subscribe<TexturedFrameMessage>(
        "texture_odometry/frame", 100, [this](const TexturedFrameMessage::ConstPtr& message) {
          counter_.receive();
          if (message->payload != nullptr) return receive(message->payload);
          counter_.drop("from another process");
          NODELET_ERROR_THROTTLE(5.0, "texture_odometry runs in another process; load it in the same nodelet manager");
        });
  } else {
    sensor_subscriber_ = std::make_unique<RgbdSubscriber>(handle, rgbd_, device_, counter_, [this](const SensorFramePtr& sensor) {
      auto frame = std::make_shared<TexturedFrame>();
      frame->sensor = sensor;
      frame->motion.reason = frame->features.reason = "no texture odometry";
      receive(frame);
    });
  }
  startReporting();
}

void IcpTrackingNodelet::loadAll() {
  ParameterTable table = parameters_.icp_tracking.table();
  for (const ParameterTable& rows : {rgbd_.table(), pose_.table()}) table.insert(table.end(), rows.begin(), rows.end());
  table.push_back({"device", &device_, 0, 0, "OpenCL device: index, part of its name, cpu or gpu; empty: the best", {}, true});
  table.push_back({"map", &map_name_, 0, 0, "the nodelet that has the map; empty: tsdf_fusion beside this one", {}, true});
  table.push_back({"texture_odometry", &use_texture_, 0, 1,
                   "true: frames come from texture_odometry; false: from the topics, with the last pose as the prior", {}, true});
  table.push_back({"queue_size", &queue_size_, 1, 1000, "frames that wait at most; the oldest are dropped", {}, true});
  table.push_back({"on_clock_jump", &on_clock_jump_, 0, 0,
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

void IcpTrackingNodelet::receive(const TexturedFramePtr& frame) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    newest_stamp_ = frame->sensor->header.stamp;
    if (frame->sensor->clock_jumps != std::exchange(newest_jumps_, frame->sensor->clock_jumps)) reset_stamp_ = ros::Time();
  }
  worker_->push(frame);
}

void IcpTrackingNodelet::receiveView(const MapViewMessage::ConstPtr& view) {
  if (view->payload == nullptr) {
    NODELET_ERROR_THROTTLE(5.0, "tsdf_fusion runs in another process; load it in the same nodelet manager");
    return;
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    views_.push_back(view);
    if (views_.size() > kMaxViews) views_.pop_front();  // nobody sends frames, and fusion has them from elsewhere
    if (view->payload->reason == kBeforeReset && !view->payload->accepted && view->payload->view == nullptr) {
      // Frames that are still on their way count by their stamps, where those are of the clock that fusion goes by.
      const bool same_clock = std::abs((view->header.stamp - newest_stamp_).toSec()) < kSameClock_s;
      reset_stamp_ = same_clock ? std::max(view->header.stamp, newest_stamp_) : newest_stamp_;
    }
  }
  changed_.notify_all();
}

void IcpTrackingNodelet::process(const TexturedFramePtr& waiting) {
  StageTimers timers;
  TexturedFramePtr frame = waiting;
  TrackingResult result;
  try {
    if (tracker_ == nullptr) prepare(frame->sensor->rgbd.intrinsics);
    awaitAnswer();
    frame = worker_->nextIfFull(frame);
    prepare(frame->sensor->rgbd.intrinsics);
    catchUp(*frame->sensor);
    result.reason = refusal(frame->sensor->header.stamp);
    if (result.reason.empty()) {
      result = track(frame, timers);
    } else {
      tracker_->reject();
    }
  } catch (const std::exception& error) {
    NODELET_ERROR_STREAM_THROTTLE(5.0, getName() << ": " << error.what());
    result = TrackingResult();
    result.reason = error.what();
    if (tracker_ != nullptr) tracker_->reject();
  }
  publish(*frame, result, timers);
  if (result.status != TrackingStatus::kLost) send(frame, result);
  recordTimings(timers);
}

std::string IcpTrackingNodelet::refusal(const ros::Time& stamp) {
  if (mode_ == MapMode::kPaused) return "paused";
  const std::lock_guard<std::mutex> lock(mutex_);
  return stamp <= reset_stamp_ ? kBeforeReset : "";
}

void IcpTrackingNodelet::prepare(const CameraIntrinsics& camera) {
  if (tracker_ != nullptr && sameCamera(camera, camera_)) return;
  if (tracker_ != nullptr) NODELET_WARN("the camera's intrinsics have changed; the sensor is searched for in the map");
  const std::shared_ptr<ComputeContext> compute = sharedCompute(device_);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    compute_ = compute;
  }
  NODELET_INFO_STREAM("OpenCL device: " << compute_->selfTestReport());
  renderer_.reset();
  tracker_ = std::make_unique<FrameTracker>(*compute_, parameters_, camera,
                                            [this](const Pose& T_W_D) -> const ModelView& { return render(T_W_D); });
  camera_ = camera;
  if (view_ != nullptr) tracker_->expectAt(view_->T_W_D);
}

void IcpTrackingNodelet::catchUp(const SensorFrame& frame) {
  if (frame.clock_jumps != std::exchange(clock_jumps_, frame.clock_jumps)) {
    tracker_->reject();
    if (on_clock_jump_ == "reset" && mode_ == MapMode::kMapping) {
      forgetMap();
      begins_map_ = true;
    }
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<Skipped> later;
  for (const Skipped& skipped : skipped_) {
    if (skipped.clock_jumps > frame.clock_jumps || skipped.stamp_s > frame.rgbd.stamp_s) {
      later.push_back(skipped);
    } else if (skipped.clock_jumps == frame.clock_jumps) {
      tracker_->skip(skipped.stamp_s, skipped.motion);
    }
  }
  skipped_.swap(later);
}

void IcpTrackingNodelet::awaitAnswer() {
  constexpr auto kPeriod = std::chrono::milliseconds(200);
  constexpr auto kPatience = std::chrono::seconds(60);  // kernels may have to be built first
  const auto give_up = std::chrono::steady_clock::now() + kPatience;
  std::unique_lock<std::mutex> lock(mutex_);
  do {
    for (; !views_.empty(); views_.pop_front()) apply(*views_.front());
    if (!sent_ || frame_publisher_.getNumSubscribers() == 0) break;
    changed_.wait_for(lock, kPeriod, [this] { return stopping_ || !views_.empty(); });
  } while (!stopping_ && std::chrono::steady_clock::now() < give_up);
  if (!sent_) return;
  if (!stopping_) NODELET_ERROR_STREAM(getName() << ": no answer from tsdf_fusion to the last frame, which counts as lost");
  sent_.reset();
  tracker_->reject();
}

void IcpTrackingNodelet::apply(const MapViewMessage& message) {
  const MapView& view = *message.payload;
  const bool answers = sent_ && message.header.stamp == sent_->frame->sensor->header.stamp;
  mode_ = view.mode;
  if (view.map_generation != map_generation_) {
    map_generation_ = view.map_generation;
    if (!(answers && view.accepted)) return startFrom(view);
  }
  if (!answers) return;
  if (view.accepted) {
    tracker_->accept(sent_->frame->sensor->rgbd, sent_->frame->features, sent_->tracked.tracking.T_W_D);
    view_ = view.view;
  } else {
    tracker_->reject();
  }
  sent_.reset();
}

void IcpTrackingNodelet::startFrom(const MapView& view) {
  forgetMap();
  view_ = view.view;
  if (view_ != nullptr) tracker_->expectAt(view_->T_W_D);
}

void IcpTrackingNodelet::forgetMap() {
  tracker_->reset();
  pose_publisher_->reset();
  view_.reset();
  sent_.reset();
  renderer_.reset();
  map_.reset();
}

TrackingResult IcpTrackingNodelet::track(const TexturedFramePtr& frame, StageTimers& timers) {
  if (frame_publisher_.getNumSubscribers() == 0) {
    TrackingResult result;
    result.reason = "no map to track against; load tsdf_fusion in the same nodelet manager";
    return result;
  }
  const Pose start = view_ == nullptr ? pose_publisher_->startPose(frame->sensor->header) : Pose::Identity();
  const TrackingResult result =
      tracker_->track(frame->sensor->rgbd, frame->motion, frame->features, view_.get(), timers, start);
  if (result.status == TrackingStatus::kLost) tracker_->reject();
  return result;
}

void IcpTrackingNodelet::send(const TexturedFramePtr& frame, const TrackingResult& result) {
  sent_ = Sent{frame, {frame->sensor, tracker_->depth(), result, map_generation_, std::exchange(begins_map_, false)}};
  frame_publisher_.publish(makeMessage<TrackedFrame>(frame->sensor->header, std::make_shared<TrackedFrame>(sent_->tracked)));
}

void IcpTrackingNodelet::publish(const TexturedFrame& frame, const TrackingResult& result, StageTimers& timers) {
  const std_msgs::Header& header = frame.sensor->header;
  const bool lost = result.status == TrackingStatus::kLost;
  const double latency_s = (ros::Time::now() - header.stamp).toSec();
  if (lost) {
    pose_publisher_->publishLost(header);
    counter_.drop(mode_ == MapMode::kPaused ? "paused" : result.reason == kBeforeReset ? kBeforeReset : "lost");
  } else {
    counter_.process();
    try {
      pose_publisher_->publish(header, result.T_W_D, result.covariance);
    } catch (const Error& error) {
      NODELET_WARN_STREAM_THROTTLE(5.0, getName() << ": no transform sent: " << error.what());
    }
    timers.record("icp_tracking/latency", 1e3 * latency_s);
  }
  auto status = boost::make_shared<TrackerStatus>();
  status->header = header;
  status->state = static_cast<uint8_t>(result.status);
  if (lost && mode_ == MapMode::kPaused) status->state = TrackerStatus::PAUSED;
  status->reason = result.reason;
  status->inliers = result.inliers;
  status->inlier_fraction = result.inlier_fraction;
  status->rmse_m = result.rmse_m;
  status->smallest_eigenvalue = result.smallest_eigenvalue;
  status->prior = view_ == nullptr ? "start" : frame.motion.found ? "texture" : "last pose";
  status->latency_s = latency_s;
  status->keyframes = tracker_ == nullptr ? 0 : static_cast<uint32_t>(tracker_->keyframeCount());
  status->frames = counter_.account();
  status_publisher_.publish(status);
  const std::lock_guard<std::mutex> lock(mutex_);
  status_ = *status;
}

const ModelView& IcpTrackingNodelet::render(const Pose& T_W_D) {
  const std::shared_ptr<SharedMap> map = findMap(map_name_);
  check(map != nullptr, "no map of " + map_name_ + " in this process; load tsdf_fusion in the same nodelet manager, or set ~map");
  if (map != map_ || renderer_ == nullptr) {
    renderer_.reset();
    map_ = map;
    renderer_ = std::make_unique<ModelViewRenderer>(*map_->compute, map_->map, camera_);
  }
  const std::lock_guard<std::mutex> lock(map_->mutex);
  const PreprocessingParameters range = withinSensorRange(parameters_).preprocessing;
  StageTimers timers;
  return renderer_->render(T_W_D, range.min_range_m, range.max_range_m, timers);
}

void IcpTrackingNodelet::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const std::string problem = sensor_subscriber_ ? sensor_subscriber_->problem() : "";
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!problem.empty()) {
    status.summary(diagnostic_msgs::DiagnosticStatus::WARN, problem);
  } else if (status_.state == TrackerStatus::LOST && !status_.reason.empty()) {
    status.summary(diagnostic_msgs::DiagnosticStatus::ERROR,
                   "lost: " + status_.reason + "; move the sensor back to where it has been");
  } else if (!status_.reason.empty()) {
    status.summary(diagnostic_msgs::DiagnosticStatus::WARN, status_.reason);
  }
  status.add("inliers", status_.inliers);
  status.add("rmse_m", status_.rmse_m);
  status.add("keyframes", status_.keyframes);
  status.add("queue", worker_->waiting());
  if (compute_ != nullptr) status.add("device", compute_->device().name);
}

}  // namespace depth_fusion

PLUGINLIB_EXPORT_CLASS(depth_fusion::IcpTrackingNodelet, nodelet::Nodelet)
