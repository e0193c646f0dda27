#include "ros/bags/bag_file.h"

#include <filesystem>
#include <fstream>
#include <map>
#include <set>

namespace depth_fusion {
namespace {

std::unique_ptr<rosbag::Bag> openBagFile(const std::string& path) {
  std::error_code unreadable;
  check(std::filesystem::exists(path, unreadable), path + ": there is no such bag; check the path");
  check(isBagFile(path), path + ": is no bag of ROS 1");
  try {
    auto bag = std::make_unique<rosbag::Bag>();
    bag->open(path, rosbag::bagmode::Read);
    return bag;
  } catch (const std::exception& error) {
    throw Error(path + ": the bag has no whole index (" + error.what() +
                "), as one that is still written, or was not closed; repair it with: rosbag reindex " + path);
  }
}

}  // namespace

bool isBagFile(const std::string& path) {
  const std::string magic = "#ROSBAG V";
  std::ifstream file(path, std::ios::binary);
  std::string begin(magic.size(), '\0');
  file.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  return begin == magic;
}

BagFiles::BagFiles(const std::vector<std::string>& paths)
    : name_(paths.front() + (paths.size() > 1 ? " and " + std::to_string(paths.size() - 1) + " more" : "")) {
  std::map<std::string, std::string> types;
  for (const std::string& path : paths) {
    bags_.push_back(openBagFile(path));
    rosbag::View everything(*bags_.back());
    for (const rosbag::ConnectionInfo* connection : everything.getConnections()) {
      types[connection->topic] = connection->datatype;
    }
  }
  for (const auto& [name, type] : types) topics_.push_back({name, type});
}

std::vector<std::string> BagFiles::publishers(const std::string& topic) const {
  std::set<std::string> names;
  for (const auto& bag : bags_) {
    rosbag::View view(*bag, rosbag::TopicQuery(topic));
    for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
      const auto name = connection->header->find("callerid");
      if (name != connection->header->end()) names.insert(name->second);
    }
  }
  return {names.begin(), names.end()};
}

void BagFiles::addTo(rosbag::View& view, const std::vector<std::string>& topics) const {
  for (const auto& bag : bags_) view.addQuery(*bag, rosbag::TopicQuery(topics));
}

}  // namespace depth_fusion
