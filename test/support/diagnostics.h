// What the nodelets say of themselves on /diagnostics.
#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>

#include <string>

#include "support/nodelet_graph.h"

namespace depth_fusion {

class Diagnostics {
 public:
  explicit Diagnostics(NodeletGraph& graph) : graph_(graph), arrays_(graph.handle(), "/diagnostics") {}

  // What the nodelet says first, from now on, at that level with those words; its level is -1 if it never
  // does.
  diagnostic_msgs::DiagnosticStatus await(const std::string& nodelet, int level, const std::string& words,
                                          double patience_s = kPatience_s) const {
    const std::string name = graph_.resolve(nodelet).substr(1);
    const size_t before = arrays_.count();
    size_t seen = 0;
    diagnostic_msgs::DiagnosticStatus found;
    found.level = -1;
    arrays_.await(
        [&](const diagnostic_msgs::DiagnosticArray& array) {
          if (++seen <= before) return false;
          for (const diagnostic_msgs::DiagnosticStatus& status : array.status) {
            if (status.name.find(name) == std::string::npos || status.level != level ||
                status.message.find(words) == std::string::npos)
              continue;
            found = status;
            return true;
          }
          return false;
        },
        patience_s);
    return found;
  }
  bool says(const std::string& nodelet, int level, const std::string& words,
            double patience_s = kPatience_s) const {
    return await(nodelet, level, words, patience_s).level == level;
  }

 private:
  NodeletGraph& graph_;
  Listener<diagnostic_msgs::DiagnosticArray> arrays_;
};

// The value of a key; empty if the nodelet does not give it.
inline std::string valueOf(const diagnostic_msgs::DiagnosticStatus& status, const std::string& key) {
  for (const diagnostic_msgs::KeyValue& value : status.values) {
    if (value.key == key) return value.value;
  }
  return "";
}

}  // namespace depth_fusion
