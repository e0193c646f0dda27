#include "tools/plots/line_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "depth_fusion/common/error.h"
#include "tools/plots/drawing.h"
#include "tools/plots/nice_step.h"

namespace depth_fusion {
namespace {

const cv::Rect kFrame(70, 50, 640, 360);
const cv::Size kCanvas(740, 470);
constexpr int kLegend_px = 170;
const cv::Scalar kColors[] = {{180, 120, 30}, {40, 120, 240}, {60, 160, 50},
                              {150, 60, 150}, {160, 160, 40}, {50, 50, 50}};

std::string shortNumber(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.4g", value);
  return text;
}

// Maps values to the part of the frame's width or height.
struct Axis {
  double low = 0.0, high = 0.0;  // logarithms, if so
  bool logarithmic = false;

  double fractionOf(double value) const {
    return ((logarithmic ? std::log10(value) : value) - low) / (high - low);
  }
  // Returns the values at which lines are drawn across.
  std::vector<double> ticks() const {
    std::vector<double> values;
    if (!logarithmic) {
      for (double value = low; value <= high; value += niceStep(high - low)) values.push_back(value);
      return values;
    }
    for (int power = static_cast<int>(std::floor(low)); power <= high; ++power) {
      for (const double factor : {1.0, 2.0, 5.0}) {
        const double value = factor * std::pow(10.0, power);
        if (fractionOf(value) >= 0.0 && fractionOf(value) <= 1.0) values.push_back(value);
      }
    }
    return values;
  }
};

Axis axisOf(const LinePlot& plot, double cv::Point2d::*coordinate) {
  double least = std::numeric_limits<double>::max(), most = 0.0;
  for (const PlotLine& line : plot.lines) {
    for (const cv::Point2d& point : line.points) {
      least = std::min(least, point.*coordinate);
      most = std::max(most, point.*coordinate);
    }
  }
  check(most > 0.0, "there is nothing to plot");
  if (!plot.logarithmic) return {0.0, 1.05 * most, false};
  check(least > 0.0, "a logarithmic plot needs positive numbers");
  return {std::log10(0.8 * least), std::log10(1.25 * most), true};
}

struct Axes {
  Axis x, y;

  cv::Point pixelOf(const cv::Point2d& point) const {
    return {kFrame.x + static_cast<int>(x.fractionOf(point.x) * kFrame.width),
            kFrame.br().y - static_cast<int>(y.fractionOf(point.y) * kFrame.height)};
  }
};

void drawAxes(cv::Mat& canvas, const LinePlot& plot, const Axes& axes) {
  for (const double x : axes.x.ticks()) {
    const int column = kFrame.x + static_cast<int>(axes.x.fractionOf(x) * kFrame.width);
    cv::line(canvas, {column, kFrame.y}, {column, kFrame.br().y}, kGrid);
    writeCentred(canvas, shortNumber(x), {column, kFrame.br().y + 16});
  }
  for (const double y : axes.y.ticks()) {
    const int row = kFrame.br().y - static_cast<int>(axes.y.fractionOf(y) * kFrame.height);
    cv::line(canvas, {kFrame.x, row}, {kFrame.br().x, row}, kGrid);
    writeCentred(canvas, shortNumber(y), {kFrame.x - 30, row});
  }
  cv::rectangle(canvas, kFrame, kInk, 1, cv::LINE_AA);
  writeCentred(canvas, plot.title, {kCanvas.width / 2, 15});
  writeCentred(canvas, plot.x_label, {kCanvas.width / 2, kCanvas.height - 18});
  writeCentred(canvas, plot.y_label, {kFrame.x + 60, kFrame.y - 12});
}

// Finds the upper corner with fewer points of the lines.
int legendColumn(const LinePlot& plot, const Axes& axes) {
  int on_left = 0, on_right = 0;
  for (const PlotLine& line : plot.lines) {
    for (const cv::Point2d& point : line.points) {
      if (axes.y.fractionOf(point.y) < 0.5) continue;
      ++(axes.x.fractionOf(point.x) < 0.5 ? on_left : on_right);
    }
  }
  return on_left < on_right ? kFrame.x + 20 : kFrame.br().x - kLegend_px;
}

}  // namespace

cv::Mat draw(const LinePlot& plot) {
  const Axes axes{axisOf(plot, &cv::Point2d::x), axisOf(plot, &cv::Point2d::y)};
  cv::Mat canvas(kCanvas, CV_8UC3, cv::Scalar::all(255));
  drawAxes(canvas, plot, axes);
  const int legend_column = legendColumn(plot, axes);
  int legend_row = kFrame.y + 20;
  for (size_t i = 0; i < plot.lines.size(); ++i, legend_row += 20) {
    const auto& points = plot.lines[i].points;
    const cv::Scalar color = kColors[i % std::size(kColors)];
    for (size_t k = 1; k < points.size(); ++k) {
      cv::line(canvas, axes.pixelOf(points[k - 1]), axes.pixelOf(points[k]), color, 2, cv::LINE_AA);
    }
    const cv::Point legend(legend_column, legend_row);
    cv::line(canvas, legend, legend + cv::Point(25, 0), color, 2, cv::LINE_AA);
    cv::putText(canvas, plot.lines[i].name, legend + cv::Point(32, 5), cv::FONT_HERSHEY_SIMPLEX, 0.45, kInk,
                1, cv::LINE_AA);
  }
  return canvas;
}

}  // namespace depth_fusion
