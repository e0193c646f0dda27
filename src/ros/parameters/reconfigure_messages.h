// dynamic_reconfigure's messages from parameter tables.
#pragma once

#include <dynamic_reconfigure/Config.h>
#include <dynamic_reconfigure/ConfigDescription.h>
#include <ros/node_handle.h>

#include <string>
#include <vector>

#include "depth_fusion/common/parameters.h"

namespace depth_fusion {

// The rows that stand in one namespace of the parameter server.
struct ParameterGroup {
  std::string name;  // of the stage; empty: the nodelet's own rows
  ros::NodeHandle handle;
  ParameterTable table;
};

struct Setting {
  std::string name;  // <stage>/<name>, or <name> of a nodelet's own row
  std::string text;
};

// The rows of all groups by their full names.
ParameterTable joinedTable(const std::vector<ParameterGroup>& groups);

// The values as they are.
dynamic_reconfigure::Config makeConfig(const std::vector<ParameterGroup>& groups);

dynamic_reconfigure::ConfigDescription makeDescription(const std::vector<ParameterGroup>& groups,
                                                       const dynamic_reconfigure::Config& defaults);

std::vector<Setting> settingsOf(const dynamic_reconfigure::Config& config);

void writeToParameterServer(const ParameterGroup& group);

}  // namespace depth_fusion
