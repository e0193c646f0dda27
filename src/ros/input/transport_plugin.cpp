#include "ros/input/transport_plugin.h"

#include <image_transport/image_transport.h>
#include <ros/names.h>

#include <algorithm>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// Those of `own` and those of plugins, which are loaded to see whether they can be.
std::vector<std::string> availableTransports(const std::vector<std::string>& own) {
  std::vector<std::string> names = own;
  for (const std::string& plugin :
       image_transport::ImageTransport(ros::NodeHandle()).getLoadableTransports()) {
    const std::string name = plugin.substr(plugin.rfind('/') + 1);
    if (!contains(names, name)) names.push_back(name);
  }
  return names;
}

}  // namespace

void checkTransport(const std::string& image, const std::string& transport,
                    const std::vector<std::string>& own) {
  if (contains(own, transport)) return;
  const std::vector<std::string> available = availableTransports(own);
  if (contains(available, transport)) return;
  std::string names;
  for (const std::string& name : available) names += (names.empty() ? "" : ", ") + name;
  throw Error("nothing decodes the transport '" + transport + "' of " + image + "; there are " + names +
              "; choose one of these, or install a plugin of image_transport for it");
}

image_transport::Subscriber subscribeByPlugin(
    const ros::NodeHandle& handle, const std::string& image, const std::string& transport,
    uint32_t queue_size, const std::function<void(const sensor_msgs::ImageConstPtr&)>& take) {
  const ros::NodeHandle parameters(handle, ros::names::parentNamespace(image) + "/image_transport");
  return image_transport::ImageTransport(handle).subscribe(
      handle.resolveName(image), queue_size, take, ros::VoidPtr(),
      image_transport::TransportHints(transport, ros::TransportHints(), parameters));
}

}  // namespace depth_fusion
