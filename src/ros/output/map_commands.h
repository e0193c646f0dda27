// The services by which a user commands a live map: reset_volume, clear_region and set_mode.
#pragma once

#include <depth_fusion/SetMode.h>
#include <ros/node_handle.h>
#include <std_srvs/Trigger.h>

#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "ros/callbacks/callback_gate.h"
#include "ros/in_process/frame_mapper.h"
#include "ros/output/region_clearing.h"

namespace depth_fusion {

// Tells tracker and users of what became of a map; is called in SharedMap::locked.
using AnnounceMap = std::function<void(const std::string& news, FusedMap& map)>;

class MapCommands {
 public:
  // Offers the services in the handle's namespace. Keeps a reference to the mapper.
  MapCommands(std::shared_ptr<SharedMap> map, FrameMapper& mapper, ros::NodeHandle handle,
              const CallbackGate& callbacks, AnnounceMap announce);

 private:
  bool reset(std_srvs::Trigger::Response& response);
  bool clear(const ClearRegion::Request& request, ClearRegion::Response& response);
  bool setMode(const SetMode::Request& request, SetMode::Response& response);

  const std::shared_ptr<SharedMap> map_;
  FrameMapper& mapper_;
  const AnnounceMap announce_;
  std::mutex region_mutex_;
  RegionClearing region_;
  ros::ServiceServer reset_server_, region_server_, mode_server_;
};

}  // namespace depth_fusion
