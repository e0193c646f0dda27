#include "ros/output/map_commands.h"

#include <ros/console.h>

#include <iterator>
#include <utility>

#include "depth_fusion/common/error.h"

namespace depth_fusion {

MapCommands::MapCommands(std::shared_ptr<SharedMap> map, FrameMapper& mapper, ros::NodeHandle handle,
                         const CallbackGate& callbacks, AnnounceMap announce)
    : map_(std::move(map)), mapper_(mapper), announce_(std::move(announce)), region_(map_) {
  reset_server_ = callbacks.advertiseService<std_srvs::Trigger::Request, std_srvs::Trigger::Response>(
      handle, "reset_volume", [this](auto&, auto& response) { return reset(response); });
  region_server_ = callbacks.advertiseService<ClearRegion::Request, ClearRegion::Response>(
      handle, "clear_region", [this](auto& request, auto& response) { return clear(request, response); });
  mode_server_ = callbacks.advertiseService<SetMode::Request, SetMode::Response>(
      handle, "set_mode", [this](auto& request, auto& response) { return setMode(request, response); });
}

bool MapCommands::reset(std_srvs::Trigger::Response& response) {
  const MapReset reset{ros::WallTime::now(), ros::Time::now()};
  map_->locked([&](FusedMap& map) {
    mapper_.reset(map, reset);
    announce_("the map was emptied by reset_volume", map);
  });
  response.success = true;
  response.message = "the map is empty; it begins anew with the next frame";
  return true;
}

bool MapCommands::clear(const ClearRegion::Request& request, ClearRegion::Response& response) {
  const std::lock_guard<std::mutex> lock(region_mutex_);
  try {
    response = region_.clear(request);
  } catch (const Error& error) {
    response.message = error.what();
  }
  ROS_INFO_STREAM("clear_region: " << response.message);
  return true;
}

bool MapCommands::setMode(const SetMode::Request& request, SetMode::Response& response) {
  constexpr const char* kModes[] = {"mapping: frames are tracked, and fused into the map",
                                    "localisation only: frames are tracked, and the map stays as it is",
                                    "paused: frames are neither tracked nor fused"};
  response.success = request.mode < std::size(kModes);
  response.message = "mode must be 0 (mapping), 1 (localisation) or 2 (paused)";
  if (!response.success) return true;
  response.message = kModes[request.mode];
  map_->locked([&](FusedMap& map) {
    mapper_.admission().setMode(static_cast<MapMode>(request.mode));
    announce_(response.message, map);
  });
  return true;
}

}  // namespace depth_fusion
