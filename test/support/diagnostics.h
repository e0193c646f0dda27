// What the nodelets say of themselves on /diagnostics.
#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>

#include <functional>
#include <string>

#include "support/nodelet_graph.h"

namespace depth_fusion {

class Diagnostics {
 public:
  using Status = diagnostic_msgs::DiagnosticStatus;

  // Listens to the nodelets in the handle's namespace.
  explicit Diagnostics(ros::NodeHandle& handle) : handle_(handle), arrays_(handle, "/diagnostics") {}

  // Waits for the first status from now on that fits, and returns it; its level is -1 if none comes.
  Status await(const std::string& nodelet, const std::function<bool(const Status&)>& fits,
               double patience_s = kPatience_s) const {
    const std::string name = handle_.resolveName(nodelet).substr(1);
    const size_t before = arrays_.count();
    size_t seen = 0;
    Status found;
    found.level = -1;
    const auto contains = [&](const diagnostic_msgs::DiagnosticArray& array) {
      if (++seen <= before) return false;
      for (const Status& status : array.status) {
        if (status.name.find(name) == std::string::npos || !fits(status)) continue;
        found = status;
        return true;
      }
      return false;
    };
    arrays_.await(contains, patience_s);
    return found;
  }
  Status await(const std::string& nodelet, int level, const std::string& words,
               double patience_s = kPatience_s) const {
    const auto fits = [&](const Status& status) {
      return status.level == level && status.message.find(words) != std::string::npos;
    };
    return await(nodelet, fits, patience_s);
  }
  bool says(const std::string& nodelet, int level, const std::string& words) const {
    return await(nodelet, level, words).level == level;
  }

 private:
  ros::NodeHandle& handle_;
  Listener<diagnostic_msgs::DiagnosticArray> arrays_;
};

// Returns the value of a key; it is empty if the nodelet does not give it.
inline std::string valueOf(const Diagnostics::Status& status, const std::string& key) {
  for (const diagnostic_msgs::KeyValue& value : status.values) {
    if (value.key == key) return value.value;
  }
  return "";
}

// Counts the frames that were dropped, for whatever reason.
inline uint64_t framesDropped(const Diagnostics::Status& status) {
  uint64_t sum = 0;
  for (const diagnostic_msgs::KeyValue& value : status.values) {
    if (value.key.rfind("dropped: ", 0) == 0) sum += std::stoull(value.value);
  }
  return sum;
}

}  // namespace depth_fusion
