#include "ros/parameters/reconfigure_server.h"

#include <ros/console.h>

#include <algorithm>
#include <mutex>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

// The servers of this process. The mutex is held while any of them makes a change.
struct Servers {
  std::mutex mutex;
  std::vector<ReconfigureServer*> all;
};

Servers& servers() {
  static Servers instance;
  return instance;
}

// The row's value if it were set to the text. Throws Error as setParameter does.
std::string valueAfter(const Parameter& row, const std::string& text) {
  return std::visit(
      [&](const auto* value) {
        auto trial = *value;
        Parameter copy = row;
        copy.value = &trial;
        setParameter({copy}, row.name, text);
        return valueText(copy);
      },
      row.value);
}

bool belongsTo(const Setting& setting, const ParameterGroup& group) {
  return !group.name.empty() && setting.name.compare(0, group.name.size() + 1, group.name + "/") == 0;
}

}  // namespace

ReconfigureServer::ReconfigureServer(std::vector<ParameterGroup> groups,
                                     const dynamic_reconfigure::Config& defaults, Nodelet nodelet)
    : groups_(std::move(groups)), table_(joinedTable(groups_)), nodelet_(std::move(nodelet)) {
  Servers& known = servers();
  const std::lock_guard<std::mutex> lock(known.mutex);
  ros::NodeHandle& handle = groups_.front().handle;
  description_publisher_ =
      handle.advertise<dynamic_reconfigure::ConfigDescription>("parameter_descriptions", 1, true);
  description_publisher_.publish(makeDescription(groups_, defaults));
  update_publisher_ = handle.advertise<dynamic_reconfigure::Config>("parameter_updates", 1, true);
  publish();
  server_ = callbacks_.advertiseService<dynamic_reconfigure::Reconfigure::Request,
                                        dynamic_reconfigure::Reconfigure::Response>(
      handle, "set_parameters", [this](auto& request, auto& response) { return serve(request, response); });
  known.all.push_back(this);
}

ReconfigureServer::~ReconfigureServer() {
  callbacks_.close();
  Servers& known = servers();
  const std::lock_guard<std::mutex> lock(known.mutex);
  known.all.erase(std::remove(known.all.begin(), known.all.end(), this), known.all.end());
}

bool ReconfigureServer::serve(dynamic_reconfigure::Reconfigure::Request& request,
                              dynamic_reconfigure::Reconfigure::Response& response) {
  Servers& known = servers();
  const std::lock_guard<std::mutex> lock(known.mutex);
  const std::vector<Setting> changed = change(settingsOf(request.config));
  for (ReconfigureServer* other : known.all) {
    if (other != this) shareWith(*other, changed);
  }
  response.config = makeConfig(groups_);
  return true;
}

std::vector<Setting> ReconfigureServer::change(const std::vector<Setting>& wanted) {
  std::vector<Setting> changed;
  nodelet_.between_frames([&] { changed = take(wanted); });
  for (Setting& setting : changed) setting.text = valueText(findParameter(table_, setting.name));
  if (!changed.empty()) publish();
  return changed;
}

std::vector<Setting> ReconfigureServer::take(const std::vector<Setting>& wanted) {
  std::vector<Setting> before;
  for (const Setting& setting : wanted) {
    try {
      if (const auto old = set(setting)) before.push_back(*old);
    } catch (const Error& error) {
      warn(error.what());
    }
  }
  if (before.empty()) return before;
  try {
    nodelet_.apply();
  } catch (const Error& error) {
    warn(std::string(error.what()) + "; nothing is changed");
    for (const Setting& old : before) setParameter(table_, old.name, old.text);
    before.clear();
    nodelet_.apply();
  }
  return before;
}

std::optional<Setting> ReconfigureServer::set(const Setting& wanted) {
  const Parameter& row = findParameter(table_, wanted.name);
  const std::string old = valueText(row);
  if (valueAfter(row, wanted.text) == old) return std::nullopt;
  check(!row.at_start_only, "parameter '" + row.name + "' can be set at the start only; it stays " + old);
  setParameter(table_, wanted.name, wanted.text);
  return Setting{wanted.name, old};
}

void ReconfigureServer::shareWith(ReconfigureServer& other, const std::vector<Setting>& changed) const {
  std::vector<Setting> shared;
  for (const ParameterGroup& mine : groups_) {
    for (const ParameterGroup& theirs : other.groups_) {
      if (mine.name != theirs.name || mine.handle.getNamespace() != theirs.handle.getNamespace()) continue;
      std::copy_if(changed.begin(), changed.end(), std::back_inserter(shared),
                   [&](const Setting& setting) { return belongsTo(setting, mine); });
    }
  }
  if (!shared.empty()) other.change(shared);
}

void ReconfigureServer::publish() {
  for (const ParameterGroup& group : groups_) writeToParameterServer(group);
  update_publisher_.publish(makeConfig(groups_));
}

void ReconfigureServer::warn(const std::string& message) const {
  ROS_WARN("%s: %s", nodelet_.name.c_str(), message.c_str());
}

}  // namespace depth_fusion
