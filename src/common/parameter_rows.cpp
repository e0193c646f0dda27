// How rows of parameters are made and put together.
#include <string>
#include <variant>
#include <vector>

#include "depth_fusion/common/parameters.h"

namespace depth_fusion {

Parameter flag(const std::string& name, bool* value, const std::string& help) {
  return {name, value, 0.0, 1.0, help};
}

Parameter number(const std::string& name, std::variant<int*, float*> value, double minimum, double maximum,
                 const std::string& help) {
  return std::visit([&](auto* member) { return Parameter{name, member, minimum, maximum, help}; }, value);
}

Parameter text(const std::string& name, std::string* value, const std::string& help) {
  return {name, value, 0.0, 0.0, help};
}

Parameter choice(const std::string& name, std::string* value, const std::vector<std::string>& choices,
                 const std::string& help) {
  return {name, value, 0.0, 0.0, help, choices};
}

Parameter atStartOnly(Parameter row) {
  row.at_start_only = true;
  return row;
}

ParameterTable atStartOnly(ParameterTable table) {
  for (Parameter& parameter : table) parameter.at_start_only = true;
  return table;
}

ParameterTable expert(ParameterTable table) {
  for (Parameter& parameter : table) parameter.is_expert = true;
  return table;
}

ParameterTable joined(const std::vector<ParameterTable>& tables) {
  ParameterTable all;
  for (const ParameterTable& table : tables) all.insert(all.end(), table.begin(), table.end());
  return all;
}

ParameterTable withPrefix(const std::string& stage, ParameterTable stage_table) {
  for (Parameter& parameter : stage_table) parameter.name = stage + "/" + parameter.name;
  return stage_table;
}

}  // namespace depth_fusion
