// TSDF fusion: frames with poses into the map, model views out of it; services to reset it and to stop and go
// on.
#include <depth_fusion/SetMode.h>
#include <std_srvs/Trigger.h>

#include <pluginlib/class_list_macros.hpp>

#include "depth_fusion/pipeline/motion_model.h"
#include "depth_fusion/pipeline/warm_up.h"
#include "depth_fusion/preprocessing/depth_preprocessor.h"
#include "ros/conversions/messages.h"
#include "ros/conversions/status_messages.h"
#include "ros/in_process/shared_map.h"
#include "ros/in_process/worker.h"
#include "ros/input/posed_frame_subscriber.h"
#include "ros/nodelets/stage_nodelet.h"
#include "ros/output/model_picture.h"

namespace depth_fusion {

class TsdfFusionNodelet : public StageNodelet {
 public:
  ~TsdfFusionNodelet() override;

 private:
  struct Outcome {
    bool accepted = false;
    bool fused = false;
    std::string reason;
    size_t blocks_left_out = 0;
  };

  void start() override;
  void loadAll();
  void applyParameters() override;
  void betweenFrames(const std::function<void()>& action) override { worker_->between(action); }
  void subscribe();

  // In the worker's thread:
  void process(const TrackedFramePtr& frame);
  void prepare(const CameraIntrinsics& camera);
  bool isFromBeforeReset(const TrackedFrame& frame) const;
  bool beginsMap(const TrackedFrame& frame);
  // The caller of these and of those marked below holds the map's mutex.
  Outcome map(const TrackedFrame& frame, StageTimers& timers);
  Outcome fuse(const TrackedFrame& frame, StageTimers& timers);
  void render(const TrackedFrame& frame, StageTimers& timers);
  void answer(const std_msgs::Header& header, const Outcome& outcome);
  void publishStatus(const std_msgs::Header& header, const Outcome& outcome);
  // To tracker and users, what no frame brought about: without a stamp.
  void announce(const std::string& news);

  void resetMap();  // with the mutex
  bool serveReset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool serveMode(SetMode::Request& request, SetMode::Response& response);
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) override;

  PipelineParameters parameters_;
  RgbdParameters rgbd_;
  std::string device_, map_frame_ = "map", tracking_ = "internal", on_clock_jump_ = "reset";
  ModelPictureParameters picture_parameters_;
  int queue_size_ = 2, tf_queue_size_ = 30;

  // What the map's mutex guards:
  std::shared_ptr<SharedMap> map_;
  uint32_t first_generation_ = 0;  // of the map before any reset
  MapReset reset_;
  MapMode mode_ = MapMode::kMapping;
  CameraIntrinsics camera_;
  MotionModel motion_;                               // of frames with poses from elsewhere
  std::unique_ptr<DepthPreprocessor> preprocessor_;  // the same
  std::shared_ptr<const ModelView> view_;            // of the last accepted frame
  uint32_t clock_jumps_ = 0;
  std::unique_ptr<ModelPicture> picture_;

  std::mutex status_mutex_;
  MapStatus status_;

  ros::Publisher view_publisher_, status_publisher_;
  ros::Subscriber frame_subscriber_;
  ros::ServiceServer reset_server_, mode_server_;
  std::unique_ptr<Worker<TrackedFramePtr>> worker_;
  std::unique_ptr<PosedFrameSubscriber> posed_subscriber_;  // of frames with poses from elsewhere
};

TsdfFusionNodelet::~TsdfFusionNodelet() {
  stopReporting();
  reset_server_.shutdown();
  mode_server_.shutdown();
  frame_subscriber_.shutdown();
  posed_subscriber_.reset();
  if (worker_ != nullptr) worker_->stop();
}

void TsdfFusionNodelet::start() {
  loadAll();
  ros::NodeHandle& handle = getMTPrivateNodeHandle();
  map_ = std::make_shared<SharedMap>(sharedCompute(device_), parameters_);
  map_->frame_id = map_frame_;
  first_generation_ = map_->generation;
  offerMap(getPrivateNodeHandle().getNamespace(), map_);
  NODELET_INFO_STREAM("OpenCL device: " << map_->compute->selfTestReport());
  warmUp(*map_->compute, parameters_);

  view_publisher_ = handle.advertise<MapViewMessage>("model_view", kProcessQueue);
  status_publisher_ = handle.advertise<MapStatus>("status", 100, true);
  picture_ = std::make_unique<ModelPicture>(handle.advertise<sensor_msgs::Image>("model_view/image", 1));
  worker_ = std::make_unique<Worker<TrackedFramePtr>>(
      queue_size_, [this](const TrackedFramePtr& frame) { process(frame); },
      [this](const TrackedFramePtr&) { counter_.drop(kTooSlow); });
  subscribe();
  reset_server_ = handle.advertiseService("reset_volume", &TsdfFusionNodelet::serveReset, this);
  mode_server_ = handle.advertiseService("set_mode", &TsdfFusionNodelet::serveMode, this);
  startReporting();
}

void TsdfFusionNodelet::loadAll() {
  const ParameterTable own = {deviceRow(device_),
                              {"map_frame", &map_frame_, 0, 0, "frame of the map", {}, true},
                              {"tracking",
                               &tracking_,
                               0,
                               0,
                               "internal: frames with poses from icp_tracking; external: frames from the "
                               "topics, poses from tf at their stamps",
                               {"internal", "external"},
                               true},
                              queueSizeRow(queue_size_),
                              {"tf_queue_size",
                               &tf_queue_size_,
                               1,
                               10000,
                               "external: frames that wait for their pose at most",
                               {},
                               true},
                              {"on_clock_jump",
                               &on_clock_jump_,
                               0,
                               0,
                               "external: what a clock that goes back does to the map",
                               {"reset", "keep"}}};
  ParameterTable table = parameters_.tsdf_fusion.table();
  for (const ParameterTable& rows : {rgbd_.table(), own, picture_parameters_.table()})
    table.insert(table.end(), rows.begin(), rows.end());
  loadParameters(table, {{"map", parameters_.map.table()},
                         {"registration", rgbd_.registration.table()},
                         {"depth_sensor", parameters_.depth_sensor.table()},
                         {"preprocessing", parameters_.preprocessing.table()},
                         {"model_view", parameters_.model_view.table()},
                         {"color_fusion", parameters_.color_fusion.table()}});
}

void TsdfFusionNodelet::applyParameters() {
  validateRange(parameters_.preprocessing, parameters_.depth_sensor);
  if (posed_subscriber_ != nullptr) posed_subscriber_->setParameters(rgbd_);
  if (map_ == nullptr) return;
  const std::lock_guard<std::mutex> lock(map_->mutex);
  map_->setParameters(parameters_);
  if (preprocessor_ != nullptr)
    preprocessor_->setParameters(parameters_.preprocessing, parameters_.depth_sensor);
}

void TsdfFusionNodelet::subscribe() {
  if (tracking_ == "internal") {
    frame_subscriber_ = subscribeInProcess<TrackedFrame>(
        "icp_tracking/frame", "icp_tracking", Carries::kFrames,
        [this](const TrackedFrameMessage::ConstPtr& message) { worker_->push(message->payload); });
  } else {
    posed_subscriber_ = std::make_unique<PosedFrameSubscriber>(
        getMTNodeHandle(), rgbd_, device_, map_frame_, tf_queue_size_, counter_,
        [this](const TrackedFramePtr& frame) { worker_->push(frame); });
  }
}

void TsdfFusionNodelet::process(const TrackedFramePtr& frame) {
  StageTimers timers;
  Outcome outcome;
  const std_msgs::Header& header = frame->sensor->header;
  const std::lock_guard<std::mutex> lock(map_->mutex);
  try {
    prepare(frame->sensor->rgbd.intrinsics);
    outcome = map(*frame, timers);
    if (outcome.accepted) render(*frame, timers);
    answer(header, outcome);
    if (outcome.accepted)
      picture_->publish(header, map_->mapper(camera_).renderer(), picture_parameters_, timers);
  } catch (const std::exception& error) {
    outcome.reason = error.what();
    NODELET_ERROR_STREAM_THROTTLE(5.0, getName() << ": " << error.what());
    answer(header, outcome);
  }
  outcome.accepted ? counter_.process() : counter_.drop(outcome.reason);
  publishStatus(header, outcome);
  recordTimings(timers);
}

void TsdfFusionNodelet::prepare(const CameraIntrinsics& camera) {
  if (sameCamera(camera, camera_)) return;
  camera_ = camera;
  view_.reset();
  motion_ = MotionModel();
  preprocessor_.reset();
}

bool TsdfFusionNodelet::isFromBeforeReset(const TrackedFrame& frame) const {
  if (reset_.isAfter(*frame.sensor)) return true;
  if (tracking_ == "external" || frame.map_generation == map_->generation) return false;
  // A tracker that has not heard of a map yet may begin the very first one.
  return frame.map_generation != 0 || map_->generation != first_generation_ || map_->map.usage().blocks > 0;
}

bool TsdfFusionNodelet::beginsMap(const TrackedFrame& frame) {
  const bool clock_jumped =
      frame.sensor->clock_jumps > std::exchange(clock_jumps_, frame.sensor->clock_jumps);
  return tracking_ == "external" ? clock_jumped && on_clock_jump_ == "reset" : frame.begins_map;
}

TsdfFusionNodelet::Outcome TsdfFusionNodelet::map(const TrackedFrame& frame, StageTimers& timers) {
  if (isFromBeforeReset(frame)) return {false, false, kBeforeReset};
  if (frame.sensor->clock_jumps < clock_jumps_) return {false, false, "from before a clock jump"};
  const bool begins = beginsMap(frame);
  if (mode_ == MapMode::kPaused) return {false, false, "paused"};
  if (mode_ == MapMode::kLocalisation) {
    return {map_->map.usage().blocks > 0 && !frame.begins_map, false, "localisation only"};
  }
  if (begins) resetMap();
  return fuse(frame, timers);
}

TsdfFusionNodelet::Outcome TsdfFusionNodelet::fuse(const TrackedFrame& frame, StageTimers& timers) {
  const RgbdFrame& rgbd = frame.sensor->rgbd;
  const Pose& T_W_D = frame.tracking.T_W_D;
  if (frame.depth == nullptr && preprocessor_ == nullptr)
    preprocessor_ = std::make_unique<DepthPreprocessor>(*map_->compute, parameters_.preprocessing, camera_,
                                                        parameters_.depth_sensor);
  const DepthFrame& depth =
      frame.depth ? *frame.depth : preprocessor_->process(rgbd, motion_.moveTo(rgbd.stamp_s, T_W_D), timers);
  Mapper& mapper = map_->mapper(camera_);
  const MappingResult result = mapper.fuse(rgbd, depth, T_W_D, timers);
  if (map_->isFollowed()) map_->noteUpdated(mapper.updatedBlocks(result));
  if (!result.fusion.fused()) return {false, false, notFusedReason()};
  return {true, true, leftOutReason(result), result.fusion.blocks_requested - result.fusion.blocks_allocated};
}

void TsdfFusionNodelet::render(const TrackedFrame& frame, StageTimers& timers) {
  if (view_publisher_.getNumSubscribers() == 0 && !picture_->hasViewers()) return;
  Mapper& mapper = map_->mapper(camera_);
  mapper.render(frame.tracking.T_W_D, timers);
  view_ = mapper.renderer().view();
}

void TsdfFusionNodelet::answer(const std_msgs::Header& header, const Outcome& outcome) {
  view_publisher_.publish(makeMessage<MapView>(
      header, std::make_shared<MapView>(
                  MapView{view_, outcome.accepted, outcome.reason, map_->generation, mode_, reset_, map_})));
}

void TsdfFusionNodelet::announce(const std::string& news) {
  answer(std_msgs::Header(), {false, false, news});
  publishStatus(std_msgs::Header(), {});
}

void TsdfFusionNodelet::publishStatus(const std_msgs::Header& header, const Outcome& outcome) {
  auto status = boost::make_shared<MapStatus>();
  status->header = header;
  status->fused = outcome.fused;
  status->reason = outcome.reason;
  status->mode = static_cast<uint8_t>(mode_);
  status->generation = map_->generation;
  setUsage(*status, map_->map.usage());
  status->blocks_left_out = outcome.blocks_left_out;
  status->frames = counter_.account();
  status_publisher_.publish(status);
  const std::lock_guard<std::mutex> lock(status_mutex_);
  status_ = *status;
}

void TsdfFusionNodelet::resetMap() {
  map_->reset();
  view_.reset();
}

bool TsdfFusionNodelet::serveReset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  const MapReset reset{ros::WallTime::now(), ros::Time::now()};
  const std::lock_guard<std::mutex> lock(map_->mutex);
  resetMap();
  reset_ = reset;
  announce("the map is empty");
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
  announce("another mode");
  return true;
}

void TsdfFusionNodelet::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const std::string problem = posed_subscriber_ ? posed_subscriber_->problem() : "";
  const std::lock_guard<std::mutex> lock(status_mutex_);
  depth_fusion::diagnose(status_, problem, status);
  status.add("queue", worker_->waiting());
  status.add("device", map_->compute->device().name);
}

}  // namespace depth_fusion

PLUGINLIB_EXPORT_CLASS(depth_fusion::TsdfFusionNodelet, nodelet::Nodelet)
