#include "depth_fusion/evaluation/line_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

const cv::Rect kFrame(70, 50, 640, 360);
const cv::Size kCanvas(740, 470);
const cv::Scalar kInk(50, 50, 50);
const cv::Scalar kGrid(228, 228, 228);
const cv::Scalar kColors[] = {{180, 120, 30}, {40, 120, 240}, {60, 160, 50}, {150, 60, 150}};

void writeCentred(cv::Mat& canvas, const std::string& text, const cv::Point& centre) {
  int baseline = 0;
  const cv::Size size = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, 0.45, 1, &baseline);
  cv::putText(canvas, text, centre + cv::Point(-size.width / 2, size.height / 2), cv::FONT_HERSHEY_SIMPLEX,
              0.45, kInk, 1, cv::LINE_AA);
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.4g", value);
  return text;
}

// 1, 2 or 5 times a power of ten, so that about six fit into the extent.
double niceStep(double extent) {
  const double power = std::pow(10.0, std::floor(std::log10(extent / 6.0)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= extent / 6.0) return factor * power;
  }
  return 10.0 * power;
}

cv::Point2d extentOf(const LinePlot& plot) {
  cv::Point2d extent(0.0, 0.0);
  for (const PlotLine& line : plot.lines) {
    for (const cv::Point2d& point : line.points) {
      extent = {std::max(extent.x, 1.05 * point.x), std::max(extent.y, 1.05 * point.y)};
    }
  }
  check(extent.x > 0.0 && extent.y > 0.0, "there is nothing to plot");
  return extent;
}

cv::Point pixelOf(const cv::Point2d& point, const cv::Point2d& extent) {
  return {kFrame.x + static_cast<int>(point.x / extent.x * kFrame.width),
          kFrame.br().y - static_cast<int>(point.y / extent.y * kFrame.height)};
}

void drawAxes(cv::Mat& canvas, const LinePlot& plot, const cv::Point2d& extent) {
  for (double x = 0.0; x <= extent.x; x += niceStep(extent.x)) {
    const int column = pixelOf({x, 0.0}, extent).x;
    cv::line(canvas, {column, kFrame.y}, {column, kFrame.br().y}, kGrid);
    writeCentred(canvas, number(x), {column, kFrame.br().y + 16});
  }
  for (double y = 0.0; y <= extent.y; y += niceStep(extent.y)) {
    const int row = pixelOf({0.0, y}, extent).y;
    cv::line(canvas, {kFrame.x, row}, {kFrame.br().x, row}, kGrid);
    writeCentred(canvas, number(y), {kFrame.x - 30, row});
  }
  cv::rectangle(canvas, kFrame, kInk, 1, cv::LINE_AA);
  writeCentred(canvas, plot.title, {kCanvas.width / 2, 15});
  writeCentred(canvas, plot.x_label, {kCanvas.width / 2, kCanvas.height - 18});
  writeCentred(canvas, plot.y_label, {kFrame.x + 60, kFrame.y - 12});
}

}  // namespace

cv::Mat draw(const LinePlot& plot) {
  const cv::Point2d extent = extentOf(plot);
  cv::Mat canvas(kCanvas, CV_8UC3, cv::Scalar::all(255));
  drawAxes(canvas, plot, extent);
  int legend_row = kFrame.y + 20;
  for (size_t i = 0; i < plot.lines.size(); ++i, legend_row += 20) {
    const auto& points = plot.lines[i].points;
    const cv::Scalar color = kColors[i % 4];
    for (size_t k = 1; k < points.size(); ++k) {
      cv::line(canvas, pixelOf(points[k - 1], extent), pixelOf(points[k], extent), color, 2, cv::LINE_AA);
    }
    const cv::Point legend(kFrame.br().x - 170, legend_row);
    cv::line(canvas, legend, legend + cv::Point(25, 0), color, 2, cv::LINE_AA);
    cv::putText(canvas, plot.lines[i].name, legend + cv::Point(32, 5), cv::FONT_HERSHEY_SIMPLEX, 0.45, kInk,
                1, cv::LINE_AA);
  }
  return canvas;
}

}  // namespace depth_fusion
