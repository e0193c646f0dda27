// The services by which planners ask what is known of space, and have it written into files.
#pragma once

#include <depth_fusion/GetDistances.h>
#include <depth_fusion/SaveGrid.h>
#include <depth_fusion/SaveOctomap.h>
#include <nav_msgs/GetMap.h>
#include <ros/node_handle.h>

#include <functional>
#include <string>

#include "depth_fusion/esdf/floor_grid.h"
#include "ros/callbacks/callback_gate.h"
#include "ros/output/map_transforms.h"

namespace depth_fusion {

// What is asked of, and the frame that it is in.
struct AskedSpace {
  const EsdfGrid& space;
  const FloorGridParameters& grid;
  std::string frame_id;
};

// The services run in the thread of the handle's queue.
class NavigationServices {
 public:
  // Calls with what is known by now. Throws Error where there is no map.
  using Ask = std::function<void(const std::function<void(const AskedSpace&)>&)>;

  NavigationServices(ros::NodeHandle& handle, const CallbackGate& callbacks, MapTransforms& transforms,
                     Ask ask);

 private:
  bool getDistances(const GetDistances::Request& request, GetDistances::Response& response);
  bool getMap(nav_msgs::GetMap::Response& response);
  bool saveGrid(const SaveGrid::Request& request, SaveGrid::Response& response);
  bool saveOctomap(const SaveOctomap::Request& request, SaveOctomap::Response& response);

  const Ask ask_;
  MapTransforms& transforms_;
  ros::ServiceServer distances_, map_, grid_, octomap_;
};

}  // namespace depth_fusion
