// The services by which a user commands a live map: reset_volume and set_mode.
#pragma once

#include <depth_fusion/SetMode.h>
#include <ros/node_handle.h>
#include <std_srvs/Trigger.h>

#include <functional>
#include <memory>
#include <string>

#include "ros/callbacks/callback_gate.h"
#include "ros/in_process/frame_mapper.h"

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
  bool setMode(const SetMode::Request& request, SetMode::Response& response);

  const std::shared_ptr<SharedMap> map_;
  FrameMapper& mapper_;
  const AnnounceMap announce_;
  ros::ServiceServer reset_server_, mode_server_;
};

}  // namespace depth_fusion
