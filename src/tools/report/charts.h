// Charts of a run over its frames, as SVG.
#pragma once

#include <string>
#include <vector>

#include "tools/report/run_record.h"

namespace depth_fusion {

// The colour of a state in all charts.
const char* colorOf(TrackingStatus status);
const char* nameOf(TrackingStatus status);

// The states of all frames, side by side. A column that stands for several frames has the worst of them.
std::string stateStrip(const std::vector<RecordedFrame>& frames);

struct FrameChart {
  std::string title, unit;
  std::vector<double> values;  // one a frame
  double top = 0.0;            // of the axis, which begins at 0; 0: the greatest value
  bool lowest_counts =
      false;  // a column that stands for several frames has the lowest of them, else the highest
};

// Empty without values.
std::string frameChart(const FrameChart& chart);

}  // namespace depth_fusion
