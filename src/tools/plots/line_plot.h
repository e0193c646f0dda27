// Pictures of lines with axes and a legend.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace depth_fusion {

struct PlotLine {
  std::string name;
  std::vector<cv::Point2d> points;
};

struct LinePlot {
  std::string title, x_label, y_label;
  std::vector<PlotLine> lines;
  bool logarithmic = false;  // both axes; all points are positive
};

// Draws the lines as CV_8UC3 BGR. Both axes begin at 0, logarithmic ones before the least point. Throws Error
// without points.
cv::Mat draw(const LinePlot& plot);

}  // namespace depth_fusion
