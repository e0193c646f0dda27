#include "ros/output/surface_publisher.h"

#include <pcl/point_types.h>
#include <pcl_ros/point_cloud.h>

#include <boost/make_shared.hpp>

#include "ros/conversions/surface_messages.h"

namespace depth_fusion {
namespace {

// A viewer that does not keep up costs so many messages of memory, and gets the others again when it does.
constexpr uint32_t kSurfaceQueue = 2;

// Whether a period is over; if so, the next one begins.
bool isDue(ros::WallTime& last, double rate_hz) {
  const ros::WallTime now = ros::WallTime::now();
  if ((now - last).toSec() < 1.0 / rate_hz) return false;
  last = now;
  return true;
}

}  // namespace

SurfacePublisher::SurfacePublisher(ros::NodeHandle& handle) : traffic_(kSurfaceQueue) {
  // roscpp tells of a process's first subscriber to a topic; further ones need refresh_chunks.
  const auto note_viewer = [this](const ros::SingleSubscriberPublisher&) { has_late_viewer_ = true; };
  marker_publisher_ =
      handle.advertise<visualization_msgs::MarkerArray>("markers", kSurfaceQueue, note_viewer);
  point_publisher_ = handle.advertise<SurfacePoints>("points", 1, note_viewer);
  block_publisher_ = handle.advertise<visualization_msgs::Marker>(
      "blocks", 1, [this](const ros::SingleSubscriberPublisher&) { has_late_block_viewer_ = true; });
}

void SurfacePublisher::update(const std::shared_ptr<SharedMap>& map, const LiveSurfaceParameters& live,
                              const SurfaceMeshParameters& mesh, double points_rate_hz, StageTimers& timers) {
  budget_.refill(1e6 * live.max_bandwidth_mb_s, ros::WallTime::now());
  if (map == nullptr || markerViewers() + pointViewers() == 0) {
    surface_.reset();
  } else {
    {
      const StageTimers::Scope timer(timers, "surface_mesh/update");
      updateSurface(map, live, mesh);
    }
    if (pointViewers() > 0 && budget_.left() > 0.0 && isDue(last_points_, points_rate_hz)) {
      const StageTimers::Scope timer(timers, "surface_mesh/points");
      publishPoints(*map);
    }
  }
  if (map != nullptr && block_publisher_.getNumSubscribers() > 0 && budget_.left() > 0.0 &&
      isDue(last_blocks_, points_rate_hz) && blocksChanged(*map))
    publishBlocks(*map);
}

void SurfacePublisher::updateSurface(const std::shared_ptr<SharedMap>& map, const LiveSurfaceParameters& live,
                                     const SurfaceMeshParameters& mesh) {
  if (surface_ == nullptr || !surface_->follows(map))
    surface_ = std::make_unique<LiveSurface>(map, live, mesh);
  if (has_late_viewer_.exchange(false)) surface_->showAll();
  const visualization_msgs::MarkerArrayPtr markers =
      surface_->update({markerViewers() > 0, pointViewers() > 0, traffic_.isOver()}, budget_);
  if (!markers->markers.empty()) surface_->noteLost(traffic_.publish(marker_publisher_, markers));
}

void SurfacePublisher::publishPoints(SharedMap& map) {
  if (!surface_->pointsChanged()) return;
  std_msgs::Header header;
  header.stamp = ros::Time::now();
  header.frame_id = map.frame_id;
  const Eigen::Vector3d sensor_W = map.locked([](FusedMap& fused) { return fused.cameraPosition(); });
  const boost::shared_ptr<SurfacePoints> points = surface_->points(header, sensor_W);
  budget_.spend(points->size() * sizeof(pcl::PointXYZRGBNormal));
  point_publisher_.publish(points);
}

bool SurfacePublisher::blocksChanged(SharedMap& map) {
  const auto blocks = map.locked([](FusedMap& fused) {
    return std::pair<uint32_t, size_t>(fused.map().generation(), fused.map().slots().used());
  });
  const bool is_late = has_late_block_viewer_.exchange(false);
  return std::exchange(blocks_, blocks) != blocks || is_late;
}

void SurfacePublisher::publishBlocks(SharedMap& map) {
  const auto blocks = map.locked([&](FusedMap& fused) {
    return boost::make_shared<visualization_msgs::Marker>(makeBlockMarker(map.frame_id, fused.map()));
  });
  budget_.spend(ros::serialization::serializationLength(*blocks));
  block_publisher_.publish(blocks);
}

}  // namespace depth_fusion
