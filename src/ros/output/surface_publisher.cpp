#include "ros/output/surface_publisher.h"

#include <boost/make_shared.hpp>

#include "ros/conversions/surface_messages.h"

namespace depth_fusion {
namespace {

// Whether a period is over; if so, the next one begins.
bool isDue(ros::WallTime& last, double rate_hz) {
  const ros::WallTime now = ros::WallTime::now();
  if ((now - last).toSec() < 1.0 / rate_hz) return false;
  last = now;
  return true;
}

}  // namespace

SurfacePublisher::SurfacePublisher(ros::NodeHandle& handle) {
  // roscpp tells of a process's first subscriber to a topic; further ones have to wait for refresh_chunks.
  const auto note_viewer = [this](const ros::SingleSubscriberPublisher&) { has_late_viewer_ = true; };
  marker_publisher_ = handle.advertise<visualization_msgs::MarkerArray>("markers", 20, note_viewer);
  point_publisher_ = handle.advertise<sensor_msgs::PointCloud2>("points", 1, note_viewer);
  block_publisher_ = handle.advertise<visualization_msgs::Marker>("blocks", 1);
}

void SurfacePublisher::update(const std::shared_ptr<SharedMap>& map, const LiveSurfaceParameters& live,
                              const SurfaceMeshParameters& mesh, double points_rate_hz, StageTimers& timers) {
  if (map == nullptr || markerViewers() + pointViewers() == 0) {
    surface_.reset();
  } else {
    {
      const StageTimers::Scope timer(timers, "surface_mesh/update");
      updateSurface(map, live, mesh);
    }
    if (pointViewers() > 0 && isDue(last_points_, points_rate_hz)) {
      const StageTimers::Scope timer(timers, "surface_mesh/points");
      publishPoints(map->frame_id);
    }
  }
  if (map != nullptr && block_publisher_.getNumSubscribers() > 0 && isDue(last_blocks_, points_rate_hz))
    publishBlocks(*map);
}

void SurfacePublisher::updateSurface(const std::shared_ptr<SharedMap>& map, const LiveSurfaceParameters& live,
                                     const SurfaceMeshParameters& mesh) {
  if (surface_ == nullptr || !surface_->follows(map))
    surface_ = std::make_unique<LiveSurface>(map, live, mesh);
  if (has_late_viewer_.exchange(false)) surface_->showAll();
  const visualization_msgs::MarkerArrayPtr markers =
      surface_->update(markerViewers() > 0, pointViewers() > 0);
  if (!markers->markers.empty()) marker_publisher_.publish(markers);
}

void SurfacePublisher::publishPoints(const std::string& frame_id) {
  std_msgs::Header header;
  header.stamp = ros::Time::now();
  header.frame_id = frame_id;
  point_publisher_.publish(surface_->points(header));
}

void SurfacePublisher::publishBlocks(SharedMap& map) {
  block_publisher_.publish(map.locked([&](FusedMap& fused) {
    return boost::make_shared<visualization_msgs::Marker>(makeBlockMarker(map.frame_id, fused.map()));
  }));
}

}  // namespace depth_fusion
