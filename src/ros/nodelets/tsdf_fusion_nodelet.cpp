// TSDF fusion: frames with poses into the map, model views out of it; services to reset it and to stop and go on.
#include <depth_fusion/MapStatus.h>
#include <depth_fusion/SetMode.h>
#include <pluginlib/class_list_macros.hpp>
#include <std_srvs/Trigger.h>
#include <tf2_ros/message_filter.h>
#include <tf2_ros/transform_listener.h>

#include "depth_fusion/pipeline/frame_tracker.h"
#include "depth_fusion/pipeline/mapper.h"
#include "depth_fusion/pipeline/warm_up.h"
#include "ros/messages.h"
#include "ros/nodelets/rgbd_subscriber.h"
#include "ros/nodelets/shared_map.h"
#include "ros/nodelets/stage_nodelet.h"
#include "ros/nodelets/worker.h"

namespace depth_fusion {

using TrackedFramePtr = std::shared_ptr<const TrackedFrame>;
using SensorFrameMessage = ProcessMessage<SensorFrame>;

class TsdfFusionNodelet : public StageNodelet {
 public:
  ~TsdfFusionNodelet() override;

 private:
  struct Outcome {
    bool accepted = false;
    bool fused = false;
    std::string reason;
  };

  void start() override;
  void loadAll();
  void applyParameters() override;
  void betweenFrames(const std::function<void()>& action) override { worker_->between(action); }
  void subscribeTracker();
  void subscribeSensor();
  void receiveWithPose(const SensorFrameMessage::ConstPtr& message);

  // In the worker's thread:
  void process(const TrackedFramePtr& frame);
  void prepare(const CameraIntrinsics& camera);
  Outcome map(const TrackedFrame& frame, StageTimers& timers);
  const DepthFrame& preprocess(const TrackedFrame& frame, StageTimers& timers);
  void answer(const std_msgs::Header& header, const Outcome& outcome);
  void publishStatus(const std_msgs::Header& header, const Outcome& outcome);
  void publishPicture(const std_msgs::Header& header, StageTimers& timers);

  // The caller holds the map's mutex.
  void resetMap();
  bool serveReset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool serveMode(SetMode::Request& request, SetMode::Response& response);
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) override;

  PipelineParameters parameters_;
  RgbdParameters rgbd_;
  std::string device_, map_frame_ = "map", tracking_ = "internal", on_clock_jump_ = "reset", picture_ = "shaded";
  int queue_size_ = 2, tf_queue_size_ = 30;
  float picture_rate_hz_ = 10.0f;

  std::shared_ptr<SharedMap> map_;
  std::atomic<MapMode> mode_{MapMode::kMapping};
  CameraIntrinsics camera_;
  std::unique_ptr<Mapper> mapper_;             // changed with the map's mutex held
  std::unique_ptr<FrameTracker> preprocessor_;  // of frames with poses from elsewhere
  std::shared_ptr<const ModelView> view_;       // of the last accepted frame
  uint32_t clock_jumps_ = 0;
  ros::WallTime last_picture_;

  std::mutex status_mutex_;
  MapStatus status_;
  std::string problem_;  // of poses from elsewhere

  ros::Publisher view_publisher_, status_publisher_, picture_publisher_;
  ros::Subscriber frame_subscriber_;
  ros::ServiceServer reset_server_, mode_server_;
  std::unique_ptr<Worker<TrackedFramePtr>> worker_;
  // Poses from elsewhere:
  std::unique_ptr<tf2_ros::Buffer> tf_;
  std::unique_ptr<tf2_ros::TransformListener> tf_listener_;
  std::unique_ptr<tf2_ros::MessageFilter<SensorFrameMessage>> tf_filter_;
  std::unique_ptr<RgbdSubscriber> sensor_subscriber_;
};

TsdfFusionNodelet::~TsdfFusionNodelet() {
  stopReporting();
  reset_server_.shutdown();
  mode_server_.shutdown();
  frame_subscriber_.shutdown();
  sensor_subscriber_.reset();
  tf_listener_.reset();
  tf_filter_.reset();
  worker_.reset();
}

void TsdfFusionNodelet::start() {
  loadAll();
  ros::NodeHandle& handle = getMTPrivateNodeHandle();
  map_ = std::make_shared<SharedMap>(sharedCompute(device_), parameters_.map);
  map_->frame_id = map_frame_;
  offerMap(getPrivateNodeHandle().getNamespace(), map_);
  NODELET_INFO_STREAM("OpenCL device: " << map_->compute->selfTestReport());
  warmUp(*map_->compute, parameters_);

  view_publisher_ = handle.advertise<MapViewMessage>("model_view", 100);
  status_publisher_ = handle.advertise<MapStatus>("status", 100, true);
  picture_publisher_ = handle.advertise<sensor_msgs::Image>("model_view/image", 1);
  worker_ = std::make_unique<Worker<TrackedFramePtr>>(
      queue_size_, [this](const TrackedFramePtr& frame) { process(frame); },
      [this](const TrackedFramePtr&) { counter_.drop("too slow"); });
  if (tracking_ == "internal") {
    subscribeTracker();
  } else {
    subscribeSensor();
  }
  reset_server_ = handle.advertiseService("reset_volume", &TsdfFusionNodelet::serveReset, this);
  mode_server_ = handle.advertiseService("set_mode", &TsdfFusionNodelet::serveMode, this);
  startReporting();
}

void TsdfFusionNodelet::loadAll() {
  ParameterTable table = parameters_.tsdf_fusion.table();
  for (const Parameter& row : rgbd_.table()) table.push_back(row);
  table.push_back({"device", &device_, 0, 0, "OpenCL device: index, part of its name, cpu or gpu; empty: the best", {}, true});
  table.push_back({"map_frame", &map_frame_, 0, 0, "frame of the map", {}, true});
  table.push_back({"tracking", &tracking_, 0, 0,
                   "internal: frames with poses from icp_tracking; external: frames from the topics, poses from tf at their stamps",
                   {"internal", "external"}, true});
  table.push_back({"queue_size", &queue_size_, 1, 1000, "frames with poses that wait at most; the oldest are dropped", {}, true});
  table.push_back({"tf_queue_size", &tf_queue_size_, 1, 10000, "external: frames that wait for their pose at most", {}, true});
  table.push_back({"on_clock_jump", &on_clock_jump_, 0, 0,
                   "external: what a clock that goes back does to the map", {"reset", "keep"}});
  table.push_back({"picture", &picture_, 0, 0, "of the model view, on model_view/image", {"shaded", "colored"}});
  table.push_back({"picture_rate_hz", &picture_rate_hz_, 0.1, 100.0, "at most"});
  loadParameters(table, {{"map", parameters_.map.table()},
                         {"registration", rgbd_.registration.table()},
                         {"depth_sensor", parameters_.depth_sensor.table()},
                         {"preprocessing", parameters_.preprocessing.table()},
                         {"color_fusion", parameters_.color_fusion.table()}});
}

void TsdfFusionNodelet::applyParameters() {
  validateRange(parameters_.preprocessing, parameters_.depth_sensor);
  if (sensor_subscriber_ != nullptr) sensor_subscriber_->setParameters(rgbd_);
  if (map_ == nullptr) return;
  const std::lock_guard<std::mutex> lock(map_->mutex);
  if (mapper_ != nullptr) mapper_->setParameters(parameters_);
  if (preprocessor_ != nullptr) preprocessor_->setParameters(parameters_);
}

void TsdfFusionNodelet::subscribeTracker() {
  frame_subscriber_ = getMTNodeHandle().subscribe<TrackedFrameMessage>(
      "icp_tracking/frame", 100, [this](const TrackedFrameMessage::ConstPtr& message) {
        counter_.receive();
        if (message->payload != nullptr) return worker_->push(message->payload);
        counter_.drop("from another process");
        NODELET_ERROR_THROTTLE(5.0, "icp_tracking runs in another process; load it in the same nodelet manager, or set "
                                    "tracking: external");
      });
}

void TsdfFusionNodelet::subscribeSensor() {
  tf_ = std::make_unique<tf2_ros::Buffer>();
  tf_listener_ = std::make_unique<tf2_ros::TransformListener>(*tf_, getMTNodeHandle());
  tf_filter_ = std::make_unique<tf2_ros::MessageFilter<SensorFrameMessage>>(*tf_, map_frame_, tf_queue_size_,
                                                                            getMTNodeHandle());
  tf_filter_->registerCallback(&TsdfFusionNodelet::receiveWithPose, this);
  tf_filter_->registerFailureCallback(
      [this](const SensorFrameMessage::ConstPtr& message, tf2_ros::filter_failure_reasons::FilterFailureReason) {
        std::string why;
        tf_->canTransform(map_frame_, message->header.frame_id, message->header.stamp, &why);
        counter_.drop("no pose on tf");
        NODELET_WARN_STREAM_THROTTLE(5.0, "a frame has no pose on tf: " << why);
        const std::lock_guard<std::mutex> lock(status_mutex_);
        problem_ = "no pose on tf: " + why;
      });
  sensor_subscriber_ =
      std::make_unique<RgbdSubscriber>(getMTNodeHandle(), rgbd_, device_, counter_, [this](const SensorFramePtr& sensor) {
        tf_filter_->add(makeMessage<SensorFrame>(sensor->header, sensor));
      });
}

void TsdfFusionNodelet::receiveWithPose(const SensorFrameMessage::ConstPtr& message) {
  auto frame = std::make_shared<TrackedFrame>();
  frame->sensor = message->payload;
  try {
    frame->tracking.T_W_D = fromMessage(
        tf_->lookupTransform(map_frame_, message->header.frame_id, message->header.stamp).transform);
  } catch (const tf2::TransformException& error) {
    NODELET_WARN_STREAM_THROTTLE(5.0, "a frame has no pose on tf: " << error.what());
    return counter_.drop("no pose on tf");
  }
  frame->tracking.status = TrackingStatus::kTracking;
  frame->map_generation = map_->generation;
  {
    const std::lock_guard<std::mutex> lock(status_mutex_);
    problem_.clear();
  }
  worker_->push(frame);
}

void TsdfFusionNodelet::process(const TrackedFramePtr& frame) {
  StageTimers timers;
  Outcome outcome;
  const std_msgs::Header& header = frame->sensor->header;
  try {
    const std::lock_guard<std::mutex> lock(map_->mutex);
    prepare(frame->sensor->rgbd.intrinsics);
    outcome = map(*frame, timers);
    if (outcome.accepted && view_publisher_.getNumSubscribers() + picture_publisher_.getNumSubscribers() > 0) {
      mapper_->render(frame->tracking.T_W_D, timers);
      view_ = mapper_->renderer().view();
    }
    answer(header, outcome);
    publishPicture(header, timers);
  } catch (const std::exception& error) {
    outcome.reason = error.what();
    NODELET_ERROR_STREAM_THROTTLE(5.0, getName() << ": " << error.what());
    answer(header, outcome);
  }
  if (outcome.accepted) {
    counter_.process();
  } else {
    counter_.drop(outcome.reason);
  }
  publishStatus(header, outcome);
  recordTimings(timers);
}

void TsdfFusionNodelet::prepare(const CameraIntrinsics& camera) {
  if (mapper_ != nullptr && sameCamera(camera, camera_)) return;
  camera_ = camera;
  view_.reset();
  mapper_ = std::make_unique<Mapper>(*map_->compute, map_->map, parameters_, camera);
  preprocessor_.reset();
}

TsdfFusionNodelet::Outcome TsdfFusionNodelet::map(const TrackedFrame& frame, StageTimers& timers) {
  if (frame.sensor->clock_jumps < clock_jumps_) return {false, false, "from before a clock jump"};
  const bool clock_jumped = frame.sensor->clock_jumps > std::exchange(clock_jumps_, frame.sensor->clock_jumps);
  const bool begins = tracking_ == "external" ? clock_jumped && on_clock_jump_ == "reset" : frame.begins_map;
  if (begins && mode_ == MapMode::kMapping) {
    resetMap();
    prepare(camera_);
  } else if (frame.map_generation != map_->generation &&
             !(frame.map_generation == 0 && map_->map.usage().blocks == 0)) {
    return {false, false, kBeforeReset};
  }
  if (mode_ == MapMode::kPaused) return {false, false, "paused"};
  if (mode_ == MapMode::kLocalisation) return {map_->map.usage().blocks > 0, false, "localisation only"};
  const MappingResult result =
      mapper_->fuse(frame.sensor->rgbd, preprocess(frame, timers), frame.tracking.T_W_D, timers);
  if (map_->isFollowed()) map_->noteUpdated(mapper_->updatedBlocks(result));
  if (!result.fused()) return {false, false, notFusedReason()};
  Outcome outcome{true, true, ""};
  if (result.fusion.blocks_allocated < result.fusion.blocks_requested) {
    outcome.reason = "the pool is full: new surface is left out; raise map/pool_mib or map/voxel_size_m";
  } else if (result.fusion.points_outside > 0) {
    outcome.reason = "surface outside of the map's window is left out; raise map/blocks_per_axis";
  }
  return outcome;
}

const DepthFrame& TsdfFusionNodelet::preprocess(const TrackedFrame& frame, StageTimers& timers) {
  if (frame.depth != nullptr) return *frame.depth;
  if (preprocessor_ == nullptr) {
    preprocessor_ = std::make_unique<FrameTracker>(*map_->compute, parameters_, camera_, nullptr);
  }
  preprocessor_->follow(frame.sensor->rgbd, frame.tracking.T_W_D, timers);
  return *preprocessor_->depth();
}

void TsdfFusionNodelet::answer(const std_msgs::Header& header, const Outcome& outcome) {
  auto view = std::make_shared<MapView>();
  view->view = view_;
  view->accepted = outcome.accepted;
  view->reason = outcome.reason;
  view->map_generation = map_->generation;
  view->mode = mode_;
  view_publisher_.publish(makeMessage<MapView>(header, view));
}

void TsdfFusionNodelet::publishStatus(const std_msgs::Header& header, const Outcome& outcome) {
  auto status = boost::make_shared<MapStatus>();
  status->header = header;
  status->fused = outcome.fused;
  status->reason = outcome.reason;
  status->mode = static_cast<uint8_t>(mode_.load());
  status->generation = map_->generation;
  {
    const std::lock_guard<std::mutex> lock(map_->mutex);
    const BlockSparseMap::Usage usage = map_->map.usage();
    status->blocks = usage.blocks;
    status->blocks_free = usage.capacity - usage.blocks;
    status->bytes = usage.bytes;
    status->pool_bytes = usage.pool_bytes;
  }
  status->frames = counter_.account();
  status_publisher_.publish(status);
  const std::lock_guard<std::mutex> lock(status_mutex_);
  status_ = *status;
}

void TsdfFusionNodelet::publishPicture(const std_msgs::Header& header, StageTimers& timers) {
  const ros::WallTime now = ros::WallTime::now();
  if (view_ == nullptr || picture_publisher_.getNumSubscribers() == 0) return;
  if ((now - last_picture_).toSec() < 1.0 / picture_rate_hz_) return;
  last_picture_ = now;
  const StageTimers::Scope timer(timers, "model_view/picture");
  const bool colored = picture_ == "colored" && parameters_.map.color;
  picture_publisher_.publish(boost::make_shared<sensor_msgs::Image>(makeColorImage(
      header, colored ? mapper_->renderer().coloredPicture() : mapper_->renderer().shadedPicture())));
}

void TsdfFusionNodelet::resetMap() {
  map_->reset();
  mapper_.reset();
  view_.reset();
}

bool TsdfFusionNodelet::serveReset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  for (size_t cleared = worker_->clear(); cleared > 0; --cleared) counter_.drop(kBeforeReset);
  const std::lock_guard<std::mutex> lock(map_->mutex);
  resetMap();
  answer(makeHeader(ros::Time::now(), map_frame_), {false, false, kBeforeReset});
  response.success = true;
  response.message = "the map is empty; it begins anew with the next frame";
  return true;
}

bool TsdfFusionNodelet::serveMode(SetMode::Request& request, SetMode::Response& response) {
  response.success = request.mode <= static_cast<uint8_t>(MapMode::kPaused);
  response.message = response.success ? "" : "mode must be 0 (mapping), 1 (localisation) or 2 (paused)";
  if (!response.success) return true;
  const std::lock_guard<std::mutex> lock(map_->mutex);
  mode_ = static_cast<MapMode>(request.mode);
  answer(std_msgs::Header(), {false, false, "another mode"});
  return true;
}

void TsdfFusionNodelet::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  const std::string sensor_problem = sensor_subscriber_ ? sensor_subscriber_->problem() : "";
  const std::lock_guard<std::mutex> lock(status_mutex_);
  const double used = static_cast<double>(status_.blocks) / std::max<double>(1.0, status_.blocks + status_.blocks_free);
  if (!sensor_problem.empty()) {
    status.summary(DiagnosticStatus::WARN, sensor_problem);
  } else if (!problem_.empty()) {
    status.summary(DiagnosticStatus::ERROR, problem_);
  } else if (used > 0.9) {
    status.summary(used > 0.99 ? DiagnosticStatus::ERROR : DiagnosticStatus::WARN,
                   "the pool of voxels is nearly full; raise map/pool_mib or map/voxel_size_m, or reset_volume");
  } else if (!status_.reason.empty()) {
    status.summary(DiagnosticStatus::WARN, status_.reason);
  }
  status.add("blocks", status_.blocks);
  status.addf("pool used", "%.1f %%", 100.0 * used);
  status.addf("map MiB", "%.1f", static_cast<double>(status_.bytes) / (1 << 20));
  status.add("queue", worker_->waiting());
  status.add("device", map_->compute->device().name);
}

}  // namespace depth_fusion

PLUGINLIB_EXPORT_CLASS(depth_fusion::TsdfFusionNodelet, nodelet::Nodelet)
