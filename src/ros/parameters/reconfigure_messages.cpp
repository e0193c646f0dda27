#include "ros/parameters/reconfigure_messages.h"

#include <dynamic_reconfigure/SensorLevels.h>

#include <limits>
#include <sstream>

namespace depth_fusion {
namespace {

using dynamic_reconfigure::Config;

// The decimal number that is meant: 0.1 and not 0.100000001490116.
double decimal(const Parameter& row) { return std::stod(valueText(row)); }

template <class Values, class Value>
void append(Values& values, const std::string& name, const Value& value) {
  values.emplace_back();
  values.back().name = name;
  values.back().value = value;
}

void appendValue(Config& config, const Parameter& row) {
  if (const auto* flag = std::get_if<bool*>(&row.value)) return append(config.bools, row.name, **flag);
  if (const auto* integer = std::get_if<int*>(&row.value)) return append(config.ints, row.name, **integer);
  if (const auto* text = std::get_if<std::string*>(&row.value)) return append(config.strs, row.name, **text);
  append(config.doubles, row.name, decimal(row));
}

void appendLimit(Config& config, const Parameter& row, bool is_maximum) {
  const double limit = is_maximum ? row.maximum : row.minimum;
  if (std::holds_alternative<bool*>(row.value)) return append(config.bools, row.name, is_maximum);
  if (std::holds_alternative<int*>(row.value)) return append(config.ints, row.name, static_cast<int>(limit));
  if (std::holds_alternative<std::string*>(row.value)) return append(config.strs, row.name, "");
  append(config.doubles, row.name, limit);
}

std::string typeName(const Parameter& row) {
  if (std::holds_alternative<bool*>(row.value)) return "bool";
  if (std::holds_alternative<int*>(row.value)) return "int";
  return std::holds_alternative<float*>(row.value) ? "double" : "str";
}

// A Python dictionary, which clients evaluate.
std::string enumOf(const Parameter& row) {
  if (row.choices.empty()) return "";
  std::string constants;
  for (const std::string& choice : row.choices) {
    constants += (constants.empty() ? "" : ", ") + ("{'name': '" + choice) + "', 'type': 'str', 'value': '" +
                 choice + "', 'description': '" + choice + "'}";
  }
  return "{'enum': [" + constants + "], 'enum_description': '" + row.name + "'}";
}

dynamic_reconfigure::ParamDescription describe(const Parameter& row) {
  using dynamic_reconfigure::SensorLevels;
  dynamic_reconfigure::ParamDescription description;
  description.name = row.name;
  description.type = typeName(row);
  description.level = row.at_start_only ? SensorLevels::RECONFIGURE_CLOSE : SensorLevels::RECONFIGURE_RUNNING;
  description.description = helpText(row) + (row.at_start_only ? " (at the start only)" : "");
  description.edit_method = enumOf(row);
  return description;
}

// Group 0 holds the nodelet's own rows; the others are its children.
template <class Group>
Group makeGroup(const ParameterGroup& group, size_t id) {
  Group message;
  message.name = group.name.empty() ? "Default" : group.name;
  message.id = static_cast<int>(id);
  message.parent = 0;
  return message;
}

ParameterTable namedTable(const ParameterGroup& group) {
  return group.name.empty() ? group.table : withPrefix(group.name, group.table);
}

}  // namespace

ParameterTable joinedTable(const std::vector<ParameterGroup>& groups) {
  ParameterTable all;
  for (const ParameterGroup& group : groups) {
    const ParameterTable rows = namedTable(group);
    all.insert(all.end(), rows.begin(), rows.end());
  }
  return all;
}

Config makeConfig(const std::vector<ParameterGroup>& groups) {
  Config config;
  for (size_t i = 0; i < groups.size(); ++i) {
    config.groups.push_back(makeGroup<dynamic_reconfigure::GroupState>(groups[i], i));
    config.groups.back().state = true;
  }
  for (const Parameter& row : joinedTable(groups)) appendValue(config, row);
  return config;
}

dynamic_reconfigure::ConfigDescription makeDescription(const std::vector<ParameterGroup>& groups,
                                                       const Config& defaults) {
  dynamic_reconfigure::ConfigDescription description;
  for (size_t i = 0; i < groups.size(); ++i) {
    description.groups.push_back(makeGroup<dynamic_reconfigure::Group>(groups[i], i));
    for (const Parameter& row : namedTable(groups[i]))
      description.groups.back().parameters.push_back(describe(row));
  }
  description.dflt = defaults;
  description.min.groups = description.max.groups = defaults.groups;
  for (const Parameter& row : joinedTable(groups)) {
    appendLimit(description.min, row, false);
    appendLimit(description.max, row, true);
  }
  return description;
}

std::vector<Setting> settingsOf(const Config& config) {
  std::vector<Setting> settings;
  for (const auto& flag : config.bools) settings.push_back({flag.name, flag.value != 0 ? "true" : "false"});
  for (const auto& integer : config.ints) settings.push_back({integer.name, std::to_string(integer.value)});
  for (const auto& real : config.doubles) {
    std::ostringstream text;
    text.precision(std::numeric_limits<double>::max_digits10);
    text << real.value;
    settings.push_back({real.name, text.str()});
  }
  for (const auto& text : config.strs) settings.push_back({text.name, text.value});
  return settings;
}

void writeToParameterServer(const ParameterGroup& group) {
  for (const Parameter& row : group.table) {
    if (const auto* flag = std::get_if<bool*>(&row.value)) {
      group.handle.setParam(row.name, **flag);
    } else if (const auto* integer = std::get_if<int*>(&row.value)) {
      group.handle.setParam(row.name, **integer);
    } else if (const auto* text = std::get_if<std::string*>(&row.value)) {
      group.handle.setParam(row.name, **text);
    } else {
      group.handle.setParam(row.name, decimal(row));
    }
  }
}

}  // namespace depth_fusion
