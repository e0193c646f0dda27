// What planners want of tsdf_fusion's map: distances, grids, octrees. Without a subscriber or a call it does
// nothing.
#include <ros/callback_queue.h>
#include <ros/spinner.h>

#include <pluginlib/class_list_macros.hpp>

#include "ros/nodelets/navigation_nodelet_parameters.h"
#include "ros/nodelets/stage_nodelet.h"
#include "ros/output/live_space.h"
#include "ros/output/navigation_publisher.h"
#include "ros/output/navigation_services.h"

namespace depth_fusion {

class NavigationNodelet : public StageNodelet {
 public:
  ~NavigationNodelet() override { stopServing(); }

 private:
  void start() override;
  void applyParameters() override;
  void betweenFrames(const std::function<void()>& action) override;
  std::string noMapReason() const;

  // In the queue's thread:
  void update();
  // Takes in what has changed; returns whether something has. Throws Error if there is no map.
  bool follow(StageTimers& timers);
  void publish(StageTimers& timers);
  void answer(const std::function<void(const AskedSpace&)>& reply);

  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) override;

  std::mutex work_mutex_;  // held during an update or a call, and while parameters change
  NavigationNodeletParameters parameters_;
  MapTransforms transforms_;
  std::unique_ptr<LiveSpace> space_;  // while somebody looks, and a while longer
  std::string frame_id_;              // of it
  ros::WallTime last_use_;
  std::mutex status_mutex_;
  std::string problem_;  // of the last update

  ros::CallbackQueue queue_;
  std::unique_ptr<NavigationPublisher> publisher_;
  std::unique_ptr<NavigationServices> services_;
  ros::WallTimer update_timer_;
  std::unique_ptr<ros::AsyncSpinner> spinner_;
};

void NavigationNodelet::start() {
  loadParameters(parameters_.table(), {{"esdf", parameters_.esdf.table()}});
  if (parameters_.map.empty()) parameters_.map = getNodeHandle().resolveName("tsdf_fusion");
  publisher_ = std::make_unique<NavigationPublisher>(getMTPrivateNodeHandle());
  ros::NodeHandle handle = getPrivateNodeHandle();
  handle.setCallbackQueue(&queue_);
  services_ = std::make_unique<NavigationServices>(handle, callbacks_, transforms_,
                                                   [this](const auto& reply) { answer(reply); });
  update_timer_ = callbacks_.createWallTimer(handle, ros::WallDuration(1.0 / parameters_.publish_rate_hz),
                                             [this](const ros::WallTimerEvent&) { update(); });
  spinner_ = std::make_unique<ros::AsyncSpinner>(1, &queue_);
  spinner_->start();
  startReporting();
}

void NavigationNodelet::applyParameters() {
  if (publisher_ != nullptr) publisher_->beginAnew();
  update_timer_.setPeriod(ros::WallDuration(1.0 / parameters_.publish_rate_hz));
}

void NavigationNodelet::betweenFrames(const std::function<void()>& action) {
  const std::lock_guard<std::mutex> lock(work_mutex_);
  action();
}

std::string NavigationNodelet::noMapReason() const {
  return "no map of " + parameters_.map +
         " in this process; load tsdf_fusion in the same nodelet manager, or set ~map";
}

bool NavigationNodelet::follow(StageTimers& timers) {
  const std::shared_ptr<SharedMap> map = findMap(parameters_.map);
  check(map != nullptr, noMapReason());
  last_use_ = ros::WallTime::now();
  if (space_ == nullptr || !space_->follows(map)) space_ = std::make_unique<LiveSpace>(map, parameters_.esdf);
  frame_id_ = map->frame_id;
  return space_->update(timers);
}

void NavigationNodelet::update() {
  std::string problem;
  StageTimers timers;
  try {
    betweenFrames([&] {
      if (publisher_->viewers() > 0) {
        publish(timers);
      } else if ((ros::WallTime::now() - last_use_).toSec() > parameters_.keep_s) {
        space_.reset();
      } else if (space_ != nullptr) {
        space_->update(timers);
      }
      if (space_ != nullptr) problem = space_->problem();
    });
  } catch (const std::exception& error) {
    problem = error.what();
    NODELET_ERROR_STREAM_THROTTLE(5.0, getName() << ": " << problem);
  }
  recordTimings(timers);
  const std::lock_guard<std::mutex> lock(status_mutex_);
  problem_ = problem;
}

void NavigationNodelet::publish(StageTimers& timers) {
  const bool has_changed = follow(timers);
  std::optional<Pose> T_W_L;
  const std::string& scan_frame = parameters_.navigation.scan_frame;
  if (publisher_->hasScanViewers()) {
    check(!scan_frame.empty(), "scan and obstacles need ~scan_frame, a level frame of the robot");
    T_W_L = transforms_.poseOf(scan_frame, frame_id_, ros::Time(0));
  }
  publisher_->update(space_->grid(), has_changed, frame_id_, T_W_L, parameters_.navigation, timers);
}

void NavigationNodelet::answer(const std::function<void(const AskedSpace&)>& reply) {
  StageTimers timers;
  betweenFrames([&] {
    follow(timers);
    const StageTimers::Scope timer(timers, "navigation/answer");
    reply({space_->grid(), parameters_.navigation.grid, frame_id_});
  });
  recordTimings(timers);
}

void NavigationNodelet::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const std::lock_guard<std::mutex> lock(status_mutex_);
  if (!problem_.empty()) status.summary(diagnostic_msgs::DiagnosticStatus::WARN, problem_);
  status.add("viewers", publisher_->viewers());
}

}  // namespace depth_fusion

PLUGINLIB_EXPORT_CLASS(depth_fusion::NavigationNodelet, nodelet::Nodelet)
