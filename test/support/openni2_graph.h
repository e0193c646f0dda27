// A simulated camera behind OpenNI2 itself, and the acquisition nodelet that reads it.
#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>

#include "support/nodelet_graph.h"
#include "support/test_device.h"

namespace depth_fusion {

using diagnostic_msgs::DiagnosticArray;
using diagnostic_msgs::DiagnosticStatus;

constexpr int kFrames = 60;

// Exact depth: the error of the map does not depend on how many frames a busy machine drops.
inline SimulationOptions roomOptions() {
  SimulationOptions options = smallRoom(kFrames);
  options.noise = false;
  return options;
}

inline const std::vector<RgbdFrame>& roomFrames() {
  static const std::vector<RgbdFrame> frames = simulatedFrames(roomOptions());
  return frames;
}

class OpenNi2 : public testing::Test {
 protected:
  OpenNi2()
      : graph_(std::string("openni2_") + testing::UnitTest::GetInstance()->current_test_info()->name()),
        device_(roomFrames()),
        diagnostics_(graph_.handle(), "/diagnostics") {
    device_.control.fps = 10.0;  // the test machine has more to do
    device_.apply();
    set("device_id", std::string("#1"));
    set("depth_mode", device_.mode());
    set("color_mode", device_.mode());
  }

  template <class Value>
  void set(const std::string& name, const Value& value) {
    graph_.handle().setParam("acquisition/" + name, value);
  }

  // That acquisition says so from now on.
  bool says(int level, const std::string& words) {
    const size_t before = diagnostics_.count();
    size_t seen = 0;
    return diagnostics_.await([&](const DiagnosticArray& array) {
      if (++seen <= before) return false;
      return std::any_of(array.status.begin(), array.status.end(), [&](const DiagnosticStatus& status) {
        return status.name.find(graph_.resolve("acquisition").substr(1)) != std::string::npos &&
               status.level == level && status.message.find(words) != std::string::npos;
      });
    }) != nullptr;
  }

  NodeletGraph graph_;
  TestDevice device_;
  Listener<DiagnosticArray> diagnostics_;
};

}  // namespace depth_fusion
