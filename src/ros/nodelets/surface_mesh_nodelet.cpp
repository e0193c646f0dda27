// The surface of tsdf_fusion's map: to files by a service, and to viewers as markers, points and boxes while
// it grows.
#include <ros/callback_queue.h>
#include <ros/spinner.h>

#include <pluginlib/class_list_macros.hpp>

#include "depth_fusion/surface_mesh/simplification.h"
#include "ros/output/live_surface.h"
#include "ros/output/mesh_export.h"
#include "ros/nodelets/stage_nodelet.h"
#include "ros/conversions/surface_messages.h"

namespace depth_fusion {

class SurfaceMeshNodelet : public StageNodelet {
 public:
  ~SurfaceMeshNodelet() override;

 private:
  void start() override;
  void applyParameters() override;
  void betweenFrames(const std::function<void()>& action) override;
  void loadAll();
  void checkParameters() const;
  void advertise();
  // The map of the nodelet tsdf_fusion; null without one.
  std::shared_ptr<SharedMap> findFusionMap() const { return findMap(map_name_); }

  // In the timer's thread:
  void update();
  void publishSurface(const std::shared_ptr<SharedMap>& map, bool with_markers, bool with_points);
  void publishBlocks(SharedMap& map);

  // In the service's thread:
  bool serveExport(ExportMesh::Request& request, ExportMesh::Response& response);
  ExportMesh::Response exportNow(const ExportMesh::Request& request);

  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) override;

  std::mutex work_mutex_;  // held during an update, and while parameters change
  SurfaceMeshParameters mesh_;
  LiveSurfaceParameters live_;
  float publish_rate_hz_ = 2.0f;
  float points_rate_hz_ = 1.0f;
  std::string map_name_;

  std::unique_ptr<LiveSurface> surface_;  // while somebody looks
  ros::WallTime last_points_, last_blocks_;
  std::atomic<bool> has_late_viewer_{false};

  std::mutex status_mutex_;
  std::string problem_;  // of the last update or export
  std::string last_export_;

  ros::Publisher marker_publisher_, point_publisher_, block_publisher_;
  ros::WallTimer update_timer_;
  ros::CallbackQueue export_queue_;
  ros::ServiceServer export_server_;
  std::unique_ptr<ros::AsyncSpinner> export_spinner_;
};

SurfaceMeshNodelet::~SurfaceMeshNodelet() {
  stopReporting();
  export_server_.shutdown();
  export_spinner_.reset();
  update_timer_.stop();
}

void SurfaceMeshNodelet::start() {
  loadAll();
  checkParameters();
  if (map_name_.empty()) map_name_ = getNodeHandle().resolveName("tsdf_fusion");
  advertise();
  update_timer_ = getMTPrivateNodeHandle().createWallTimer(ros::WallDuration(1.0 / publish_rate_hz_),
                                                           [this](const ros::WallTimerEvent&) { update(); });
  startReporting();
}

void SurfaceMeshNodelet::loadAll() {
  ParameterTable table = mesh_.table();
  for (const Parameter& row : live_.table()) table.push_back(row);
  table.push_back({"map",
                   &map_name_,
                   0,
                   0,
                   "the nodelet that has the map; empty: tsdf_fusion beside this one",
                   {},
                   true});
  table.push_back({"publish_rate_hz", &publish_rate_hz_, 0.1, 30.0, "of updates of the markers"});
  table.push_back(
      {"points_rate_hz", &points_rate_hz_, 0.01, 30.0, "of the points and the blocks' boxes, at most"});
  loadParameters(table);
}

void SurfaceMeshNodelet::checkParameters() const {
  check(
      live_.triangle_share == 1.0f || canSimplify(),
      "triangle_share must be 1: this depth_fusion was built without meshoptimizer, which simplifies meshes");
}

void SurfaceMeshNodelet::applyParameters() {
  checkParameters();
  surface_.reset();  // the next update shows all of it anew
  update_timer_.setPeriod(ros::WallDuration(1.0 / publish_rate_hz_));
}

void SurfaceMeshNodelet::betweenFrames(const std::function<void()>& action) {
  const std::lock_guard<std::mutex> lock(work_mutex_);
  action();
}

void SurfaceMeshNodelet::advertise() {
  ros::NodeHandle& handle = getMTPrivateNodeHandle();
  // roscpp tells of a process's first subscriber to a topic; further ones have to wait for refresh_chunks.
  const auto noteViewer = [this](const ros::SingleSubscriberPublisher&) { has_late_viewer_ = true; };
  marker_publisher_ = handle.advertise<visualization_msgs::MarkerArray>("markers", 20, noteViewer);
  point_publisher_ = handle.advertise<sensor_msgs::PointCloud2>("points", 1, noteViewer);
  block_publisher_ = handle.advertise<visualization_msgs::Marker>("blocks", 1);
  ros::NodeHandle export_handle = getPrivateNodeHandle();
  export_handle.setCallbackQueue(&export_queue_);
  export_server_ = export_handle.advertiseService("export_mesh", &SurfaceMeshNodelet::serveExport, this);
  export_spinner_ = std::make_unique<ros::AsyncSpinner>(1, &export_queue_);
  export_spinner_->start();
}

void SurfaceMeshNodelet::update() {
  std::string problem;
  try {
    const std::lock_guard<std::mutex> lock(work_mutex_);
    const std::shared_ptr<SharedMap> map = findFusionMap();
    publishSurface(map, marker_publisher_.getNumSubscribers() > 0, point_publisher_.getNumSubscribers() > 0);
    if (map != nullptr && block_publisher_.getNumSubscribers() > 0) publishBlocks(*map);
  } catch (const std::exception& error) {
    problem = error.what();
    NODELET_ERROR_STREAM_THROTTLE(5.0, getName() << ": " << problem);
  }
  const std::lock_guard<std::mutex> lock(status_mutex_);
  problem_ = problem;
}

void SurfaceMeshNodelet::publishSurface(const std::shared_ptr<SharedMap>& map, bool with_markers,
                                        bool with_points) {
  if (map == nullptr || !(with_markers || with_points)) return surface_.reset();
  StageTimers timers;
  {
    const StageTimers::Scope timer(timers, "surface_mesh/update");
    if (surface_ == nullptr || !surface_->follows(map))
      surface_ = std::make_unique<LiveSurface>(map, live_, mesh_);
    if (has_late_viewer_.exchange(false)) surface_->showAll();
    const visualization_msgs::MarkerArrayPtr markers = surface_->update(with_markers, with_points);
    if (!markers->markers.empty()) marker_publisher_.publish(markers);
  }
  const ros::WallTime now = ros::WallTime::now();
  if (with_points && (now - last_points_).toSec() >= 1.0 / points_rate_hz_) {
    const StageTimers::Scope timer(timers, "surface_mesh/points");
    last_points_ = now;
    std_msgs::Header header;
    header.stamp = ros::Time::now();
    header.frame_id = map->frame_id;
    point_publisher_.publish(surface_->points(header));
  }
  recordTimings(timers);
}

void SurfaceMeshNodelet::publishBlocks(SharedMap& map) {
  const ros::WallTime now = ros::WallTime::now();
  if ((now - last_blocks_).toSec() < 1.0 / points_rate_hz_) return;
  last_blocks_ = now;
  const auto marker = boost::make_shared<visualization_msgs::Marker>();
  {
    const std::lock_guard<std::mutex> lock(map.mutex);
    *marker = makeBlockMarker(map.frame_id, map.map);
  }
  block_publisher_.publish(marker);
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
    check(map != nullptr, "no map of " + map_name_ +
                              " in this process; load tsdf_fusion in the same nodelet manager, or set ~map");
    SurfaceMeshParameters parameters;
    betweenFrames([&] { parameters = mesh_; });
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
    status.summary(DiagnosticStatus::WARN,
                   "no map of " + map_name_ +
                       " in this process; load tsdf_fusion in the same nodelet manager, or set ~map");
  }
  status.add("viewers of markers", marker_publisher_.getNumSubscribers());
  status.add("viewers of points", point_publisher_.getNumSubscribers());
  if (!last_export_.empty()) status.add("last export", last_export_);
}

}  // namespace depth_fusion

PLUGINLIB_EXPORT_CLASS(depth_fusion::SurfaceMeshNodelet, nodelet::Nodelet)
