#include "ros/bags/bag_file.h"

#include <filesystem>
#include <fstream>
#include <map>

namespace depth_fusion {
namespace {

void checkIsBag(const std::string& path) {
  const std::string magic = "#ROSBAG V";
  std::error_code unreadable;
  check(std::filesystem::exists(path, unreadable), path + ": there is no such bag; check the path");
  std::ifstream file(path, std::ios::binary);
  std::string begin(magic.size(), '\0');
  file.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  check(begin == magic, path + ": is no bag of ROS 1");
}

}  // namespace

std::unique_ptr<rosbag::Bag> openBagFile(const std::string& path) {
  checkIsBag(path);
  try {
    auto bag = std::make_unique<rosbag::Bag>();
    bag->open(path, rosbag::bagmode::Read);
    return bag;
  } catch (const std::exception& error) {
    throw Error(path + ": the bag has no whole index (" + error.what() +
                "); repair it with: rosbag reindex " + path);
  }
}

std::vector<BagTopic> topicsOf(const rosbag::Bag& bag) {
  rosbag::View everything(bag);
  std::map<std::string, std::string> types;
  for (const rosbag::ConnectionInfo* connection : everything.getConnections()) {
    types[connection->topic] = connection->datatype;
  }
  std::vector<BagTopic> topics;
  for (const auto& [name, type] : types) topics.push_back({name, type});
  return topics;
}

}  // namespace depth_fusion
