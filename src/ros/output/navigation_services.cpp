#include "ros/output/navigation_services.h"

#include <ros/console.h>

#include <limits>
#include <utility>

#include "depth_fusion/esdf/octree_file.h"
#include "ros/conversions/messages.h"
#include "ros/conversions/navigation_messages.h"
#include "ros/output/mesh_export.h"

namespace depth_fusion {
namespace {

// Without the ending that map_saver adds itself.
std::string withoutEnding(const std::string& path) {
  const size_t ending = path.size() < 5 ? std::string::npos : path.rfind(".yaml");
  return ending != std::string::npos && ending + 5 == path.size() ? path.substr(0, ending) : path;
}

// Serves by the action, and says what is wrong if it throws.
template <class Response>
bool serve(const char* service, Response& response, const std::function<void()>& action) {
  try {
    action();
    response.success = true;
  } catch (const std::exception& error) {
    response.message = error.what();
    ROS_ERROR_STREAM(service << ": " << error.what());
  }
  return true;
}

void append(const EsdfSample& sample, const Eigen::Matrix3d& R_F_W, GetDistances::Response& response) {
  const Eigen::Vector3d gradient = R_F_W * sample.gradient.cast<double>();
  response.known.push_back(sample.is_known);
  response.distances.push_back(sample.is_known ? sample.distance_m : std::numeric_limits<float>::quiet_NaN());
  response.gradients.emplace_back();
  response.gradients.back().x = gradient.x();
  response.gradients.back().y = gradient.y();
  response.gradients.back().z = gradient.z();
}

}  // namespace

NavigationServices::NavigationServices(ros::NodeHandle& handle, const CallbackGate& callbacks,
                                       MapTransforms& transforms, Ask ask)
    : ask_(std::move(ask)), transforms_(transforms) {
  distances_ = callbacks.advertiseService<GetDistances::Request, GetDistances::Response>(
      handle, "get_distances",
      [this](auto& request, auto& response) { return getDistances(request, response); });
  map_ = callbacks.advertiseService<nav_msgs::GetMap::Request, nav_msgs::GetMap::Response>(
      handle, "static_map", [this](auto&, auto& response) { return getMap(response); });
  grid_ = callbacks.advertiseService<SaveGrid::Request, SaveGrid::Response>(
      handle, "save_grid", [this](auto& request, auto& response) { return saveGrid(request, response); });
  octomap_ = callbacks.advertiseService<SaveOctomap::Request, SaveOctomap::Response>(
      handle, "save_octomap",
      [this](auto& request, auto& response) { return saveOctomap(request, response); });
}

bool NavigationServices::getDistances(const GetDistances::Request& request,
                                      GetDistances::Response& response) {
  return serve("get_distances", response, [&] {
    ask_([&](const AskedSpace& asked) {
      const Pose T_W_F = transforms_.poseOf(request.header.frame_id, asked.frame_id, request.header.stamp);
      std::vector<Eigen::Vector3d> points_W;
      for (const geometry_msgs::Point& p : request.points)
        points_W.push_back(T_W_F * Eigen::Vector3d(p.x, p.y, p.z));
      for (const EsdfSample& sample : asked.space.distances(points_W))
        append(sample, T_W_F.linear().transpose(), response);
    });
  });
}

bool NavigationServices::getMap(nav_msgs::GetMap::Response& response) {
  try {
    ask_([&](const AskedSpace& asked) {
      response.map = makeOccupancyGrid(makeHeader(ros::Time::now(), asked.frame_id),
                                       floorGridOf(asked.space, asked.grid));
    });
    return true;
  } catch (const std::exception& error) {
    ROS_ERROR_STREAM("static_map: " << error.what());
    return false;
  }
}

bool NavigationServices::saveGrid(const SaveGrid::Request& request, SaveGrid::Response& response) {
  return serve("save_grid", response, [&] {
    check(!request.path.empty(), "path is empty; give the name of the files, without ending");
    const std::string path = withoutEnding(absolutePath(request.path));
    ask_([&](const AskedSpace& asked) { writeFloorGrid(path, floorGridOf(asked.space, asked.grid)); });
    response.message = path + ".yaml";
  });
}

bool NavigationServices::saveOctomap(const SaveOctomap::Request& request, SaveOctomap::Response& response) {
  return serve("save_octomap", response, [&] {
    check(!request.path.empty(), "path is empty; give the name of a .bt or .ot file");
    const std::string path = absolutePath(request.path);
    ask_([&](const AskedSpace& asked) {
      const OctreeSize size = writeOctree(path, asked.space);
      response.occupied = size.occupied;
      response.free = size.free;
      response.bytes = size.bytes;
    });
    response.message = path;
  });
}

}  // namespace depth_fusion
