// The surface of tsdf_fusion's map: to files and messages by a service and an action, and to viewers as
// markers, points and boxes while it grows.
#include <pluginlib/class_list_macros.hpp>

#include "ros/nodelets/stage_nodelet.h"
#include "ros/nodelets/surface_mesh_nodelet_parameters.h"
#include "ros/output/mesh_export_server.h"
#include "ros/output/surface_publisher.h"

namespace depth_fusion {

class SurfaceMeshNodelet : public StageNodelet {
 public:
  ~SurfaceMeshNodelet() override;

 private:
  void start() override;
  void applyParameters() override;
  void betweenFrames(const std::function<void()>& action) override;
  void advertise();
  // The map of the nodelet tsdf_fusion; null without one.
  std::shared_ptr<SharedMap> findFusionMap() const { return findMap(parameters_.map); }
  std::string noMapReason() const;

  void update();                            // in the timer's thread
  MeshExportServer::Source exportSource();  // in the exports' threads

  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) override;

  std::mutex work_mutex_;  // held during an update, and while parameters change
  SurfaceMeshNodeletParameters parameters_;
  std::unique_ptr<SurfacePublisher> surface_;
  std::mutex status_mutex_;
  std::string problem_;  // of the last update

  ros::WallTimer update_timer_;
  std::unique_ptr<MeshExportServer> exports_;
};

SurfaceMeshNodelet::~SurfaceMeshNodelet() { stopServing(); }

void SurfaceMeshNodelet::start() {
  loadParameters(parameters_.table(), parameters_.stages());
  if (parameters_.map.empty()) parameters_.map = getNodeHandle().resolveName("tsdf_fusion");
  advertise();
  update_timer_ = callbacks_.createWallTimer(getMTPrivateNodeHandle(),
                                             ros::WallDuration(1.0 / parameters_.publish_rate_hz),
                                             [this](const ros::WallTimerEvent&) { update(); });
  startReporting();
}

void SurfaceMeshNodelet::applyParameters() {
  if (surface_ != nullptr) surface_->beginAnew();
  update_timer_.setPeriod(ros::WallDuration(1.0 / parameters_.publish_rate_hz));
}

void SurfaceMeshNodelet::betweenFrames(const std::function<void()>& action) {
  const std::lock_guard<std::mutex> lock(work_mutex_);
  action();
}

void SurfaceMeshNodelet::advertise() {
  surface_ = std::make_unique<SurfacePublisher>(getMTPrivateNodeHandle());
  exports_ = std::make_unique<MeshExportServer>(
      getPrivateNodeHandle(), callbacks_, [this] { return exportSource(); },
      [this](const StageTimers& timers) { recordTimings(timers); });
}

std::string SurfaceMeshNodelet::noMapReason() const {
  return "no map of " + parameters_.map +
         " in this process; load tsdf_fusion in the same nodelet manager, or set ~map";
}

void SurfaceMeshNodelet::update() {
  std::string problem;
  StageTimers timers;
  try {
    betweenFrames([&] {
      surface_->update(findFusionMap(), parameters_.live, parameters_.mesh, parameters_.points_rate_hz,
                       timers);
    });
  } catch (const std::exception& error) {
    problem = error.what();
    NODELET_ERROR_STREAM_THROTTLE(5.0, getName() << ": " << problem);
  }
  recordTimings(timers);
  const std::lock_guard<std::mutex> lock(status_mutex_);
  problem_ = problem;
}

MeshExportServer::Source SurfaceMeshNodelet::exportSource() {
  MeshExportServer::Source source;
  source.map = findFusionMap();
  check(source.map != nullptr, noMapReason());
  betweenFrames([&] { source.parameters = {parameters_.mesh, parameters_.texturing}; });
  return source;
}

void SurfaceMeshNodelet::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  const std::shared_ptr<SharedMap> map = findFusionMap();
  const std::lock_guard<std::mutex> lock(status_mutex_);
  if (!problem_.empty()) {
    status.summary(DiagnosticStatus::ERROR, problem_);
  } else if (map == nullptr) {
    status.summary(DiagnosticStatus::WARN, noMapReason());
  }
  status.add("viewers of markers", surface_->markerViewers());
  status.add("viewers of points", surface_->pointViewers());
  const std::string last_export = exports_->last();
  if (!last_export.empty()) status.add("last export", last_export);
}

}  // namespace depth_fusion

PLUGINLIB_EXPORT_CLASS(depth_fusion::SurfaceMeshNodelet, nodelet::Nodelet)
