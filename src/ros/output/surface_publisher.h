// The surface and the blocks of a map on topics, as long as somebody looks.
#pragma once

#include <ros/node_handle.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <utility>

#include "ros/output/live_surface.h"

namespace depth_fusion {

class SurfacePublisher {
 public:
  // Advertises markers, points and blocks.
  explicit SurfacePublisher(ros::NodeHandle& handle);

  // Publishes what changed of the map, and now and then points and boxes, points_rate_hz at most. Null: there
  // is no map.
  void update(const std::shared_ptr<SharedMap>& map, const LiveSurfaceParameters& live,
              const SurfaceMeshParameters& mesh, double points_rate_hz, StageTimers& timers);
  // The next update shows all of the surface anew.
  void beginAnew() { surface_.reset(); }

  uint32_t markerViewers() const { return marker_publisher_.getNumSubscribers(); }
  uint32_t pointViewers() const { return point_publisher_.getNumSubscribers(); }

 private:
  void updateSurface(const std::shared_ptr<SharedMap>& map, const LiveSurfaceParameters& live,
                     const SurfaceMeshParameters& mesh);
  void publishPoints(SharedMap& map);
  void publishBlocks(SharedMap& map);
  // Whether they are others than at the last call, or somebody sees them for the first time.
  bool blocksChanged(SharedMap& map);

  std::atomic<bool> has_late_viewer_{false},
      has_late_block_viewer_{false};          // the publishers' callbacks set them
  std::pair<uint32_t, size_t> blocks_{0, 0};  // generation and number of those shown
  ros::Publisher marker_publisher_, point_publisher_, block_publisher_;
  std::unique_ptr<LiveSurface> surface_;  // while somebody looks
  MarkerTraffic traffic_;
  ByteBudget budget_;
  ros::WallTime last_points_, last_blocks_;
};

}  // namespace depth_fusion
