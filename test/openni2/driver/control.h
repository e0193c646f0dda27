// What a test tells the simulated device, by a file that both know.
#pragma once

#include <cstdio>
#include <fstream>
#include <string>

namespace depth_fusion {

constexpr const char* kTestDeviceVariable =
    "DEPTH_FUSION_TEST_DEVICE";  // the folder that has the two files and recording/
constexpr const char* kFirstUri = "5346/0001@2/7";
constexpr const char* kSecondUri = "5346/0001@3/4";
constexpr const char* kFirstSerial = "SIM-0001";
constexpr const char* kSecondSerial = "SIM-0002";

struct DeviceControl {
  bool plugged = true;
  bool second = false;  // plugged, too
  int at = 0;           // the recording is shown up to this frame; then the camera stands still
  double fps = 30.0;
  int drop = 0;               // of so many images only the first is delivered; 0: every one is
  double late_color_s = 0.0;  // colour is delivered so much later than it was taken
  bool silent = false;        // plugged, but without images
  bool registers = true;
  bool refuses_modes = false;
  bool writes_addresses = false;  // each image begins with the address that the driver wrote it to
};

inline std::string controlPath(const std::string& folder) { return folder + "/control"; }
// What the driver was set to last: "auto_exposure auto_white_balance exposure gain".
inline std::string settingsPath(const std::string& folder) { return folder + "/settings"; }

inline void writeControl(const std::string& folder, const DeviceControl& c) {
  const std::string path = controlPath(folder), unfinished = path + ".new";
  std::ofstream(unfinished) << c.plugged << ' ' << c.second << ' ' << c.at << ' ' << c.fps << ' ' << c.drop
                            << ' ' << c.late_color_s << ' ' << c.silent << ' ' << c.registers << ' '
                            << c.refuses_modes << ' ' << c.writes_addresses << '\n';
  std::rename(unfinished.c_str(), path.c_str());
}

inline DeviceControl readControl(const std::string& folder) {
  DeviceControl c;
  std::ifstream file(controlPath(folder));
  file >> c.plugged >> c.second >> c.at >> c.fps >> c.drop >> c.late_color_s >> c.silent >> c.registers >>
      c.refuses_modes >> c.writes_addresses;
  return file ? c : DeviceControl();
}

}  // namespace depth_fusion
