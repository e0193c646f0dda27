// TSDF fusion: frames with poses into the map, model views out of it; services to reset it, to stop and go
// on, to save and load it.
#include <pluginlib/class_list_macros.hpp>

#include "depth_fusion/pipeline/warm_up.h"
#include "ros/in_process/deferred.h"
#include "ros/in_process/frame_mapper.h"
#include "ros/in_process/worker.h"
#include "ros/input/posed_frame_subscriber.h"
#include "ros/nodelets/stage_nodelet.h"
#include "ros/nodelets/tsdf_fusion_nodelet_parameters.h"
#include "ros/output/map_reporter.h"
#include "ros/output/map_services.h"

namespace depth_fusion {

using WaitingFrame = Deferred<TrackedFrame>;

class TsdfFusionNodelet : public StageNodelet {
 public:
  ~TsdfFusionNodelet() override;

 private:
  void start() override;
  void advertise();
  void subscribe();
  void applyParameters() override;
  void betweenFrames(const std::function<void()>& action) override { worker_->between(action); }
  void greet();                             // tells a tracker that has come of the map
  void process(const TrackedFrame& frame);  // in the worker's thread
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) override;

  TsdfFusionNodeletParameters parameters_;
  std::shared_ptr<SharedMap> map_;
  std::unique_ptr<FrameMapper> mapper_;  // for whoever has the map locked, as is the reporter
  std::unique_ptr<MapReporter> reporter_;
  ros::Subscriber frame_subscriber_;
  std::unique_ptr<Worker<WaitingFrame>> worker_;
  std::unique_ptr<PosedFrameSubscriber> posed_subscriber_;  // of frames with poses from elsewhere
  std::unique_ptr<MapServices> services_;
};

TsdfFusionNodelet::~TsdfFusionNodelet() {
  stopServing();
  frame_subscriber_.shutdown();
  if (worker_ != nullptr) worker_->stop();
  posed_subscriber_.reset();
  services_.reset();  // saves the map, to which nothing comes any more
}

void TsdfFusionNodelet::start() {
  // The transports of the model's picture have parameters, too.
  loadParameters(parameters_.table(), parameters_.stages(), kModelPictureTopic);
  const PipelineParameters& pipeline = parameters_.pipeline;
  map_ = std::make_shared<SharedMap>(sharedCompute(parameters_.device), pipeline, parameters_.map_frame);
  mapper_ = std::make_unique<FrameMapper>(*map_, pipeline, parameters_.isExternal());
  offerMap(getPrivateNodeHandle().getNamespace(), map_);
  NODELET_INFO_STREAM("OpenCL device: " << map_->compute->selfTestReport());
  warmUp(*map_->compute, pipeline);
  advertise();
  startReporting();
}

void TsdfFusionNodelet::advertise() {
  ros::NodeHandle& handle = getMTPrivateNodeHandle();
  map_->locked([&](FusedMap&) {
    reporter_ =
        std::make_unique<MapReporter>(map_, handle, parameters_.viewFrame(), callbacks_, [this] { greet(); });
  });
  worker_ = std::make_unique<Worker<WaitingFrame>>(
      parameters_.queue_size,
      [this](const WaitingFrame& waiting) {
        if (const TrackedFramePtr frame = waiting.take()) process(*frame);
      },
      [this](const WaitingFrame&) { counter_.drop(kTooSlow); });
  const AnnounceMap announce = [this](const std::string& news, FusedMap& map) {
    reporter_->announce(news, *mapper_, map, counter_.account());
  };
  services_ = std::make_unique<MapServices>(map_, *mapper_, parameters_.keeper, parameters_.refiner, handle,
                                            callbacks_, announce);
  subscribe();
}

void TsdfFusionNodelet::subscribe() {
  if (parameters_.isExternal()) {
    // The worker's thread makes it, so that no frame is at work before it is there.
    worker_->between([this] {
      posed_subscriber_ = std::make_unique<PosedFrameSubscriber>(
          getMTNodeHandle(), parameters_.rgbd, parameters_.device, parameters_.map_frame,
          parameters_.tf_queue_size, counter_, [this](const WaitingFrame& frame) { worker_->push(frame); });
    });
  } else {
    frame_subscriber_ = subscribeInProcess<TrackedFrame>(
        "icp_tracking/frame", "icp_tracking", Carries::kFrames,
        [this](const TrackedFrameMessage::ConstPtr& message) { worker_->push(message->payload); });
  }
}

void TsdfFusionNodelet::applyParameters() {
  validateRange(parameters_.pipeline.preprocessing, parameters_.pipeline.depth_sensor);
  parameters_.rgbd.checkTexts();
  if (posed_subscriber_ != nullptr) posed_subscriber_->setParameters(parameters_.rgbd);
  if (map_ == nullptr) return;  // not started yet
  map_->locked([this](FusedMap& map) {
    map.setParameters(parameters_.pipeline);
    mapper_->setParameters(parameters_.pipeline);
  });
}

void TsdfFusionNodelet::greet() {
  map_->locked([this](FusedMap& map) {
    if (reporter_ != nullptr) reporter_->answer(std_msgs::Header(), {}, *mapper_, map);
  });
}

void TsdfFusionNodelet::process(const TrackedFrame& frame) {
  StageTimers timers;
  map_->locked([&](FusedMap& map) {
    const std_msgs::Header& header = frame.sensor->header;
    MappingOutcome outcome;
    try {
      outcome = mapper_->map(frame, map, parameters_.resetsOnClockJump(), timers);
      if (outcome.accepted && reporter_->hasViewers()) mapper_->render(frame, map, timers);
      reporter_->answer(header, outcome, *mapper_, map);
      if (outcome.accepted) reporter_->show(frame, mapper_->renderer(map), parameters_.picture, timers);
    } catch (const std::exception& error) {
      outcome.reason = error.what();
      NODELET_ERROR_STREAM_THROTTLE(5.0, getName() << ": " << error.what());
      reporter_->answer(header, outcome, *mapper_, map);
    }
    outcome.accepted ? counter_.process() : counter_.drop(outcome.reason);
    reporter_->publishStatus(header, outcome, *mapper_, map, counter_.account());
  });
  recordTimings(timers);
}

void TsdfFusionNodelet::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  reporter_->diagnose(posed_subscriber_ ? posed_subscriber_->problem() : "", status);
  services_->diagnose(status);
  status.add("queue", worker_->waiting());
  status.add("device", map_->compute->device().name);
}

}  // namespace depth_fusion

PLUGINLIB_EXPORT_CLASS(depth_fusion::TsdfFusionNodelet, nodelet::Nodelet)
