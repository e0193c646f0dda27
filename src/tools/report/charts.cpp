#include "tools/report/charts.h"

#include <algorithm>

#include "common/io/formatted_line.h"
#include "tools/report/html.h"

namespace depth_fusion {
namespace {

constexpr size_t kMostColumns = 600;
constexpr double kHeight = 100.0;

// The columns that so many frames are shown in.
struct Columns {
  size_t frames, count;

  explicit Columns(size_t all) : frames(all), count(std::min(all, kMostColumns)) {}
  size_t begin(size_t column) const { return column * frames / count; }
  size_t end(size_t column) const { return (column + 1) * frames / count; }
};

std::string svg(size_t columns, const std::string& content) {
  return "<svg viewBox=\"0 0 " + std::to_string(columns) + " " + fixed(kHeight, 0) +
         "\" preserveAspectRatio=\"none\">" + content + "</svg>";
}

std::string ends(const std::string& left, const std::string& right) {
  return "<div class=\"ends\"><span>" + left + "</span><span>" + right + "</span></div>\n";
}

}  // namespace

const char* colorOf(TrackingStatus status) {
  if (status == TrackingStatus::kLost) return "#cc4433";
  return status == TrackingStatus::kDegenerate ? "#d99a1c" : "#2a9d6f";
}

const char* nameOf(TrackingStatus status) {
  if (status == TrackingStatus::kLost) return "lost";
  return status == TrackingStatus::kDegenerate ? "degenerate" : "tracking";
}

std::string stateStrip(const std::vector<RecordedFrame>& frames) {
  if (frames.empty()) return "";
  const Columns columns(frames.size());
  const auto stateOf = [&](size_t column) {
    TrackingStatus worst = TrackingStatus::kTracking;
    for (size_t i = columns.begin(column); i < columns.end(column); ++i)
      worst = std::max(worst, frames[i].status);
    return worst;
  };
  std::string bars;
  for (size_t first = 0, last = 0; first < columns.count; first = last) {
    const TrackingStatus state = stateOf(first);
    while (last < columns.count && stateOf(last) == state) ++last;
    bars += line("<rect x=\"%zu\" y=\"0\" width=\"%zu\" height=\"100\" fill=\"%s\"><title>%s</title></rect>",
                 first, last - first, colorOf(state), nameOf(state));
  }
  const double seconds = frames.back().stamp_s - frames.front().stamp_s;
  return "<div class=\"chart strip\">" + svg(columns.count, bars) +
         ends("frame 1", "frame " + std::to_string(frames.size()) + ", " + fixed(seconds, 1) + " s") +
         "</div>\n";
}

std::string frameChart(const FrameChart& chart) {
  if (chart.values.empty()) return "";
  const Columns columns(chart.values.size());
  const double greatest = *std::max_element(chart.values.begin(), chart.values.end());
  const double top = chart.top > 0.0 ? chart.top : std::max(1.05 * greatest, 1e-9);
  std::string points;
  for (size_t column = 0; column < columns.count; ++column) {
    const auto begin = chart.values.begin() + static_cast<std::ptrdiff_t>(columns.begin(column));
    const auto end = chart.values.begin() + static_cast<std::ptrdiff_t>(columns.end(column));
    const double value = chart.lowest_counts ? *std::min_element(begin, end) : *std::max_element(begin, end);
    const double y = kHeight * (1.0 - std::min(value / top, 1.0));
    points += line("%zu,%.2f", column, y) + line("%zu,%.2f", column + 1, y);
  }
  const std::string area = "<polygon fill=\"#2f6fb2\" fill-opacity=\"0.25\" points=\"0,100 " + points +
                           std::to_string(columns.count) + ",100\"/>";
  const std::string outline =
      "<polyline fill=\"none\" stroke=\"#2f6fb2\" stroke-width=\"1.5\" vector-effect=\"non-scaling-stroke\" "
      "points=\"" +
      points + "\"/>";
  return "<div class=\"chart\">" +
         ends(escaped(chart.title), "0 to " + fixed(top, top < 10.0 ? 1 : 0) + " " + escaped(chart.unit)) +
         svg(columns.count, area + outline) + "</div>\n";
}

}  // namespace depth_fusion
