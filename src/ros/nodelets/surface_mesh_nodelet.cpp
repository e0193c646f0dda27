// The surface of tsdf_fusion's map: to files by a service, and to viewers as markers, points and boxes while
// it grows.
#include <ros/callback_queue.h>
#include <ros/spinner.h>

#include <pluginlib/class_list_macros.hpp>

#include "ros/nodelets/stage_nodelet.h"
#include "ros/nodelets/surface_mesh_nodelet_parameters.h"
#include "ros/output/mesh_export.h"
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

  void update();  // in the timer's thread
  // In the service's thread:
  bool serveExport(ExportMesh::Request& request, ExportMesh::Response& response);
  ExportMesh::Response exportNow(const ExportMesh::Request& request);

  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) override;

  std::mutex work_mutex_;  // held during an update, and while parameters change
  SurfaceMeshNodeletParameters parameters_;
  std::unique_ptr<SurfacePublisher> surface_;
  std::mutex status_mutex_;
  std::string problem_;  // of the last update or export
  std::string last_export_;

  ros::WallTimer update_timer_;
  ros::CallbackQueue export_queue_;
  ros::ServiceServer export_server_;
  std::unique_ptr<ros::AsyncSpinner> export_spinner_;
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
  ros::NodeHandle export_handle = getPrivateNodeHandle();
  export_handle.setCallbackQueue(&export_queue_);
  export_server_ = callbacks_.advertiseService<ExportMesh::Request, ExportMesh::Response>(
      export_handle, "export_mesh",
      [this](auto& request, auto& response) { return serveExport(request, response); });
  export_spinner_ = std::make_unique<ros::AsyncSpinner>(1, &export_queue_);
  export_spinner_->start();
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

bool SurfaceMeshNodelet::serveExport(ExportMesh::Request& request, ExportMesh::Response& response) {
  try {
    response = exportNow(request);
  } catch (const std::exception& error) {
    response.success = false;
    response.message = error.what();
  }
  const std::lock_guard<std::mutex> lock(status_mutex_);
  last_export_ = (response.success ? "" : "failed: ") + response.message;
  return true;
}

ExportMesh::Response SurfaceMeshNodelet::exportNow(const ExportMesh::Request& request) {
  StageTimers timers;
  ExportMesh::Response response;
  {
    const StageTimers::Scope timer(timers, "surface_mesh/export");
    const std::shared_ptr<SharedMap> map = findFusionMap();
    check(map != nullptr, noMapReason());
    MeshExportParameters parameters;
    betweenFrames([&] { parameters = {parameters_.mesh, parameters_.texturing}; });
    response = exportMesh(*map, request, parameters);
  }
  recordTimings(timers);
  return response;
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
  if (!last_export_.empty()) status.add("last export", last_export_);
}

}  // namespace depth_fusion

PLUGINLIB_EXPORT_CLASS(depth_fusion::SurfaceMeshNodelet, nodelet::Nodelet)
