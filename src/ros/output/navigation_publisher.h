// What is known of space, on topics, as long as somebody looks.
#pragma once

#include <ros/node_handle.h>

#include <atomic>
#include <optional>
#include <string>

#include "depth_fusion/common/stage_timers.h"
#include "depth_fusion/esdf/floor_grid.h"
#include "depth_fusion/geometry/pose.h"
#include "ros/output/navigation_parameters.h"

namespace depth_fusion {

class NavigationPublisher {
 public:
  explicit NavigationPublisher(ros::NodeHandle& handle);

  uint32_t viewers() const;
  bool hasScanViewers() const { return scan_.getNumSubscribers() + obstacles_.getNumSubscribers() > 0; }
  // Publishes what has changed, and everything where somebody is new; with T_W_L, the scanner's pose, scans.
  void update(const EsdfGrid& space, bool has_changed, const std::string& frame_id,
              const std::optional<Pose>& T_W_L, const NavigationParameters& parameters, StageTimers& timers);
  // The next update publishes everything.
  void beginAnew() { is_late_ = true; }

 private:
  void publishGrid(const FloorGrid& grid, const std_msgs::Header& header, bool is_late);
  void publishScan(const FloorGrid& grid, const Pose& T_W_L, const NavigationParameters& parameters);

  std::atomic<bool> is_late_{true};  // the publishers' callbacks set it, too
  ros::Publisher slice_, distances_, centres_, map_, updates_, scan_, obstacles_;
  FloorGrid grid_;  // as it was published last
  ros::WallTime last_map_;
  bool map_is_old_ = false;  // updates have gone out since
};

}  // namespace depth_fusion
