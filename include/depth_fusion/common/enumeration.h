// The one list of the names that an enumeration has, each with the value that it stands for.
#pragma once

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "depth_fusion/common/error.h"

namespace depth_fusion {

// Parameter rows take their choices from it, and kernels their options: a name that one of them knows, all
// know.
template <class Value>
class Enumeration {
 public:
  Enumeration(std::initializer_list<std::pair<std::string, Value>> entries) : entries_(entries) {}

  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& entry : entries_) names.push_back(entry.first);
    return names;
  }

  // The value that the name stands for. Throws Error for a name that is not in the list.
  const Value& of(const std::string& name) const {
    for (const auto& entry : entries_) {
      if (entry.first == name) return entry.second;
    }
    std::string known;
    for (const auto& entry : entries_) known += (known.empty() ? "" : ", ") + entry.first;
    throw Error("'" + name + "' is none of " + known);
  }

 private:
  std::vector<std::pair<std::string, Value>> entries_;
};

}  // namespace depth_fusion
