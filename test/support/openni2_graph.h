// A simulated camera behind OpenNI2 itself, and the acquisition nodelet that reads it.
#pragma once

#include "support/diagnostics.h"
#include "support/test_device.h"

namespace depth_fusion {

using diagnostic_msgs::DiagnosticStatus;

constexpr int kFrames = 60;

// Depth is exact, so that the error of the map does not depend on how many frames a busy machine drops.
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
        diagnostics_(graph_.handle()) {
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

  // Tells whether acquisition says so from now on.
  bool says(int level, const std::string& words) const {
    return diagnostics_.says("acquisition", level, words);
  }

  NodeletGraph graph_;
  TestDevice device_;
  Diagnostics diagnostics_;
};

}  // namespace depth_fusion
