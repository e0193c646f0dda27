// What was found, for the user and for the other apps.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/calibration/self_calibration.h"

namespace depth_fusion {

struct CalibrationReport {
  std::string input;
  SelfCalibration calibration;      // its corrected parameters have all that was found
  TimeOffset color;                 // of the colour's stamps against the depth's
  std::optional<TimeOffset> poses;  // of the depth's stamps against the given trajectory's
  std::optional<Estimate> scale;    // against the trajectory or the distance
};

// Says for the terminal what was found, how sure it is, and what is not known and why.
std::string reportText(const CalibrationReport& report);

// Write calibration.yaml, for --params, report.json and calibration.png into the folder. Throw Error if they
// cannot.
void writeCalibration(const std::string& folder, const CalibrationReport& report);

}  // namespace depth_fusion
