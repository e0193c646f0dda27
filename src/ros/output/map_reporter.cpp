#include "ros/output/map_reporter.h"

#include <ros/console.h>

#include <boost/make_shared.hpp>

#include "ros/conversions/status_messages.h"

namespace depth_fusion {

MapReporter::MapReporter(const std::shared_ptr<SharedMap>& map, ros::NodeHandle& handle,
                         const std::string& view_frame, const CallbackGate& callbacks,
                         const std::function<void()>& greet)
    : map_(map),
      view_publisher_(handle.advertise<MapViewMessage>(
          "model_view", kProcessQueue, [greet](const ros::SingleSubscriberPublisher&) { greet(); },
          ros::SubscriberStatusCallback(), callbacks.token())),
      status_publisher_(handle.advertise<MapStatus>("status", 100, true)),
      picture_(handle),
      submap_markers_(handle) {
  if (!view_frame.empty()) view_frame_.emplace(map->frame_id, view_frame);
}

void MapReporter::answer(const std_msgs::Header& header, const MappingOutcome& outcome,
                         const FrameMapper& mapper, FusedMap& map) {
  const FrameAdmission& admission = mapper.admission();
  view_publisher_.publish(makeMessage<MapView>(
      header, std::make_shared<MapView>(MapView{mapper.view(), outcome.accepted, outcome.reason,
                                                map.map().generation(), admission.mode(),
                                                admission.lastReset(), mapper.move(), map_})));
}

void MapReporter::publishStatus(const std_msgs::Header& header, const MappingOutcome& outcome,
                                const FrameMapper& mapper, FusedMap& map, const FrameAccount& frames) {
  auto status = boost::make_shared<MapStatus>();
  status->header = header;
  status->fused = outcome.fused;
  status->reason = outcome.reason;
  status->mode = static_cast<uint8_t>(mapper.admission().mode());
  status->generation = map.map().generation();
  setUsage(*status, map.map().usage());
  const SubmapCollection& submaps = map.submaps();
  setUsage(*status, submaps.submaps(), submaps.usage());
  status->blocks_left_out = outcome.blocks_left_out;
  if (const auto& move = mapper.move()) {
    status->moved_m = move->moved_m;
    status->jump_m = move->jump_m;
  }
  status->frames = frames;
  status_publisher_.publish(status);
  if (const auto shared = map_.lock()) submap_markers_.publish(shared->frame_id, submaps);
  const std::lock_guard<std::mutex> lock(mutex_);
  status_ = *status;
}

void MapReporter::announce(const std::string& news, const FrameMapper& mapper, FusedMap& map,
                           const FrameAccount& frames) {
  ROS_INFO_STREAM(news);
  answer(std_msgs::Header(), {false, false, news}, mapper, map);
  publishStatus(std_msgs::Header(), {false, false, news}, mapper, map, frames);
}

void MapReporter::show(const TrackedFrame& frame, ModelViewRenderer& renderer,
                       const ModelPictureParameters& parameters, StageTimers& timers) {
  const std_msgs::Header& header = frame.sensor->header;
  if (view_frame_) view_frame_->follow(header.stamp, frame.tracking.T_W_D);
  picture_.publish(header, renderer, parameters, timers);
}

void MapReporter::diagnose(const std::string& problem, diagnostic_updater::DiagnosticStatusWrapper& status) {
  const std::lock_guard<std::mutex> lock(mutex_);
  depth_fusion::diagnose(status_, problem, status);
}

}  // namespace depth_fusion
