#include "tools/plots/memory_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

#include "depth_fusion/common/error.h"
#include "tools/plots/drawing.h"

namespace depth_fusion {
namespace {

constexpr int kBarPitch_px = 26, kBarWidth_px = 18, kGroupGap_px = 14;
constexpr int kLeft_px = 80, kRight_px = 20, kTop_px = 60, kPlotHeight_px = 330, kBottom_px = 110;
constexpr double kTextSize = 0.42;
// A bar ends where it is this many times as high as the limit.
constexpr double kHighest = 1.5;

const cv::Scalar kFits(180, 120, 30), kOver(40, 40, 210);

// Writes text that reads upwards and ends at the point.
void writeUpwards(cv::Mat& canvas, const std::string& text, const cv::Point& end) {
  int baseline = 0;
  const cv::Size size = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, kTextSize, 1, &baseline);
  cv::Mat line(size.height + baseline, size.width, CV_8UC3, cv::Scalar::all(255));
  cv::putText(line, text, {0, size.height}, cv::FONT_HERSHEY_SIMPLEX, kTextSize, kInk, 1, cv::LINE_AA);
  cv::rotate(line, line, cv::ROTATE_90_COUNTERCLOCKWISE);
  line.copyTo(canvas(cv::Rect(end.x - line.cols / 2, end.y, line.cols, line.rows)));
}

std::string mebibytes(double bytes) { return std::to_string(std::lround(bytes / (1 << 20))); }

// Rows of one voxel size stand side by side.
bool beginsGroup(const ResolutionPlan& plan, size_t row) {
  return row > 0 && plan.rows[row].map.voxel_size_m != plan.rows[row - 1].map.voxel_size_m;
}

int columnOf(const ResolutionPlan& plan, size_t row) {
  int column = kLeft_px + kGroupGap_px;
  for (size_t i = 0; i < row; ++i) column += kBarPitch_px + (beginsGroup(plan, i + 1) ? kGroupGap_px : 0);
  return column;
}

int rowOf(double bytes, double limit_bytes) {
  const double fraction = std::min(bytes / limit_bytes, kHighest) / kHighest;
  return kTop_px + kPlotHeight_px - static_cast<int>(fraction * kPlotHeight_px);
}

void drawAxis(cv::Mat& canvas, const ResolutionPlan& plan) {
  const double limit = static_cast<double>(plan.request.limit_bytes);
  for (int quarter = 0; quarter <= 6; ++quarter) {
    const double bytes = 0.25 * quarter * limit;
    const int row = rowOf(bytes, limit);
    cv::line(canvas, {kLeft_px, row}, {canvas.cols - kRight_px, row}, quarter == 4 ? kOver : kGrid);
    writeCentred(canvas, mebibytes(bytes), {kLeft_px - 28, row}, kTextSize);
  }
  char title[200];
  std::snprintf(title, sizeof(title),
                "memory of the map, MiB; box of %.3g m, limit %s MiB; voxel size in mm, and N/M",
                plan.request.box_m, mebibytes(limit).c_str());
  writeCentred(canvas, title, {canvas.cols / 2, 20}, kTextSize);
}

void drawBar(cv::Mat& canvas, const ResolutionPlan& plan, size_t i) {
  const PlanRow& row = plan.rows[i];
  const double limit = static_cast<double>(plan.request.limit_bytes);
  const int column = columnOf(plan, i), bottom = kTop_px + kPlotHeight_px;
  const cv::Rect bar(cv::Point(column, rowOf(static_cast<double>(row.bytes), limit)),
                     cv::Point(column + kBarWidth_px, bottom));
  cv::rectangle(canvas, bar, fits(row, plan.request) ? kFits : kOver, cv::FILLED);
  writeUpwards(canvas, std::to_string(row.map.blocks_per_axis) + "/" + std::to_string(row.map.block_size),
               {column + kBarWidth_px / 2, bottom + 8});
  if (i > 0 && !beginsGroup(plan, i)) return;
  char voxel[32];
  std::snprintf(voxel, sizeof(voxel), "%.3g mm", 1000.0 * row.map.voxel_size_m);
  cv::putText(canvas, voxel, {column, bottom + 90}, cv::FONT_HERSHEY_SIMPLEX, kTextSize, kInk, 1,
              cv::LINE_AA);
}

}  // namespace

cv::Mat plotMemory(const ResolutionPlan& plan) {
  check(!plan.rows.empty(), "there is nothing to plot");
  const int width = columnOf(plan, plan.rows.size() - 1) + kBarPitch_px + kRight_px;
  cv::Mat canvas(kTop_px + kPlotHeight_px + kBottom_px, std::max(width, 640), CV_8UC3, cv::Scalar::all(255));
  drawAxis(canvas, plan);
  for (size_t i = 0; i < plan.rows.size(); ++i) drawBar(canvas, plan, i);
  return canvas;
}

}  // namespace depth_fusion
