// What to try when something of a run is poor.
#pragma once

#include <string>
#include <vector>

#include "tools/report/run_report.h"

namespace depth_fusion {

// Sentences, the most important first, in which what is to be typed stands between backticks. Empty if
// nothing is poor.
std::vector<std::string> adviceFor(const RunReport& report);

}  // namespace depth_fusion
