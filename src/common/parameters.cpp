#include "depth_fusion/common/parameters.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <sstream>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<size_t> row(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t substitution = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitution});
    }
  }
  return row[b.size()];
}

std::string nearestName(const ParameterTable& table, const std::string& name) {
  std::string nearest;
  size_t best = std::numeric_limits<size_t>::max();
  for (const Parameter& parameter : table) {
    const size_t distance = editDistance(parameter.name, name);
    if (distance < best) {
      best = distance;
      nearest = parameter.name;
    }
  }
  return nearest;
}

template <class Number>
Number parseNumber(const std::string& name, const std::string& text) {
  std::istringstream stream(text);
  Number number{};
  stream >> number;
  check(!stream.fail() && stream.eof(),
        "parameter '" + name + "': '" + text + "' is not a number of its type");
  return number;
}

std::string shortestText(float number) {
  std::ostringstream text;
  for (int digits = std::numeric_limits<float>::digits10; digits <= std::numeric_limits<float>::max_digits10;
       ++digits) {
    text.str("");
    text.precision(digits);
    text << number;
    if (std::strtof(text.str().c_str(), nullptr) == number) break;
  }
  return text.str();
}

std::string enumerated(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

void checkChoice(const Parameter& parameter, const std::string& value) {
  const auto& choices = parameter.choices;
  check(choices.empty() || std::find(choices.begin(), choices.end(), value) != choices.end(),
        "parameter '" + parameter.name + "' is '" + value + "'; it must be one of " + enumerated(choices));
}

void checkRange(const Parameter& parameter) {
  double number = 0.0;
  if (const auto* value = std::get_if<int*>(&parameter.value)) {
    number = **value;
  } else if (const auto* real = std::get_if<float*>(&parameter.value)) {
    number = **real;
  } else if (const auto* word = std::get_if<std::string*>(&parameter.value)) {
    return checkChoice(parameter, **word);
  } else {
    return;
  }
  // The limits are compared in float so that a float default equal to its limit passes; NaN never does.
  const bool inside = static_cast<float>(number) >= static_cast<float>(parameter.minimum) &&
                      static_cast<float>(number) <= static_cast<float>(parameter.maximum);
  if (inside) return;
  std::ostringstream message;
  message << "parameter '" << parameter.name << "' is " << number << "; it must lie in [" << parameter.minimum
          << ", " << parameter.maximum << "]";
  throw Error(message.str());
}

void flatten(const YAML::Node& node, const std::string& prefix, const ParameterTable& table) {
  for (const auto& entry : node) {
    const std::string name = prefix + entry.first.as<std::string>();
    if (entry.second.IsMap()) {
      flatten(entry.second, name + "/", table);
    } else {
      check(entry.second.IsScalar(), "parameter '" + name + "' is not a single value");
      setParameter(table, name, entry.second.Scalar());
    }
  }
}

}  // namespace

const Parameter& findParameter(const ParameterTable& table, const std::string& name) {
  const auto row =
      std::find_if(table.begin(), table.end(), [&](const Parameter& p) { return p.name == name; });
  check(row != table.end(),
        "unknown parameter '" + name + "'; did you mean '" + nearestName(table, name) + "'?");
  return *row;
}

void setParameter(const ParameterTable& table, const std::string& name, const std::string& text) {
  const Parameter& row = findParameter(table, name);
  if (const auto* flag = std::get_if<bool*>(&row.value)) {
    check(text == "true" || text == "false",
          "parameter '" + name + "': '" + text + "' is neither true nor false");
    **flag = text == "true";
  } else if (const auto* integer = std::get_if<int*>(&row.value)) {
    **integer = parseNumber<int>(name, text);
  } else if (const auto* real = std::get_if<float*>(&row.value)) {
    **real = parseNumber<float>(name, text);
  } else {
    *std::get<std::string*>(row.value) = text;
  }
  checkRange(row);
}

void loadParameterFile(const ParameterTable& table, const std::string& path) {
  try {
    const YAML::Node root = YAML::LoadFile(path);
    check(root.IsMap() || root.IsNull(), "the file holds no map of stages");
    flatten(root, "", table);
  } catch (const YAML::BadFile&) {
    throw Error("parameter file " + path + ": cannot be read; check the path");
  } catch (const std::exception& error) {
    throw Error("parameter file " + path + ": " + error.what());
  }
}

std::string valueText(const Parameter& parameter) {
  if (const auto* real = std::get_if<float*>(&parameter.value)) return shortestText(**real);
  std::ostringstream text;
  text << std::boolalpha;
  std::visit([&](const auto* value) { text << *value; }, parameter.value);
  return text.str();
}

std::string helpText(const Parameter& parameter) {
  return parameter.help + (parameter.is_expert ? " (expert)" : "");
}

std::string rangeText(const Parameter& parameter) {
  if (std::holds_alternative<bool*>(parameter.value)) return "true, false";
  if (std::holds_alternative<std::string*>(parameter.value))
    return parameter.choices.empty() ? "text" : enumerated(parameter.choices);
  std::ostringstream text;
  text << "[" << parameter.minimum << ", " << parameter.maximum << "]";
  return text.str();
}

void validate(const ParameterTable& table) {
  for (const Parameter& parameter : table) checkRange(parameter);
}

}  // namespace depth_fusion
