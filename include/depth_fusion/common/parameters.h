// One table of parameters a stage; loading, validation, printing and documentation all come from it.
//
//   ParameterTable StageParameters::table() {
//     return {number("range_m", &range_m, 0.01, 100.0, "farther depth is left out"),
//             flag("enabled", &enabled, "false: the stage does nothing")};
//   }
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "depth_fusion/common/enumeration.h"

namespace depth_fusion {

// A row bound to a member of a parameter struct. Minimum and maximum are inclusive and apply to numbers only,
// choices to texts only (none: any text). The functions below make rows.
struct Parameter {
  std::string name;  // lower_snake_case, with the unit as suffix where it has one (truncation_m)
  std::variant<bool*, int*, float*, std::string*> value;
  double minimum = 0.0;
  double maximum = 0.0;
  std::string help;
  std::vector<std::string> choices = {};
  bool at_start_only = false;  // cannot change while a nodelet runs
  bool is_expert = false;      // is hardly ever changed: it stands behind the others
};

using ParameterTable = std::vector<Parameter>;

Parameter flag(const std::string& name, bool* value, const std::string& help);

// The minimum and the maximum are values that the number may take.
Parameter number(const std::string& name, std::variant<int*, float*> value, double minimum, double maximum,
                 const std::string& help);

Parameter text(const std::string& name, std::string* value, const std::string& help);

// A text that is one of the choices.
Parameter choice(const std::string& name, std::string* value, const std::vector<std::string>& choices,
                 const std::string& help);

template <class Value>
Parameter choice(const std::string& name, std::string* value, const Enumeration<Value>& choices,
                 const std::string& help) {
  return choice(name, value, choices.names(), help);
}

// The row, or the rows, marked at_start_only.
Parameter atStartOnly(Parameter row);
ParameterTable atStartOnly(ParameterTable table);

// The rows, marked is_expert.
ParameterTable expert(ParameterTable table);

// The rows of all the tables, one after the other.
ParameterTable joined(const std::vector<ParameterTable>& tables);

// The rows of `stage_table` with names prefixed by "<stage>/".
ParameterTable withPrefix(const std::string& stage, ParameterTable stage_table);

// The row of that name. Throws Error for an unknown name, naming the nearest known one.
const Parameter& findParameter(const ParameterTable& table, const std::string& name);

// Sets one parameter from text. Throws Error for an unknown name, for text that is no value of the
// parameter's type, and for a value out of range.
void setParameter(const ParameterTable& table, const std::string& name, const std::string& text);

// Sets all the parameters of a YAML file of the form `stage: {name: value}`. Throws Error naming the file.
void loadParameterFile(const ParameterTable& table, const std::string& path);

// The current value of a row as text: the shortest that setParameter reads as the same value.
std::string valueText(const Parameter& parameter);

// The help, with a note where the row is an expert's.
std::string helpText(const Parameter& parameter);

// The values that a row takes, as text.
std::string rangeText(const Parameter& parameter);

// Throws Error if a row's value lies outside its range (for values set in code rather than from text).
void validate(const ParameterTable& table);

}  // namespace depth_fusion
