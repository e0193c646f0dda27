#include "tools/report/sections.h"

#include "depth_fusion/common/percentile.h"
#include "tools/report/advice.h"
#include "tools/report/charts.h"
#include "tools/report/html.h"
#include "tools/report/level.h"
#include "tools/report/pictures.h"

namespace depth_fusion {
namespace {

std::string fact(const std::string& name, const std::string& value) {
  return "<div><dt>" + escaped(name) + "</dt><dd>" + escaped(value) + "</dd></div>\n";
}

double wayLength_m(const Trajectory& trajectory) {
  double length_m = 0.0;
  for (size_t i = 1; i < trajectory.size(); ++i)
    length_m += (trajectory[i].T_W_D.translation() - trajectory[i - 1].T_W_D.translation()).norm();
  return length_m;
}

std::string verdictOf(const RunReport& report) {
  const std::vector<RecordedFrame>& frames = report.record.frames();
  const size_t lost = countOf(frames, TrackingStatus::kLost);
  const std::string all = std::to_string(frames.size());
  const auto verdict = [](const char* kind, const std::string& text) {
    return std::string("<p class=\"verdict ") + kind + "\">" + escaped(text) + "</p>\n";
  };
  if (2 * lost > frames.size() || frames.empty())
    return verdict("bad",
                   std::to_string(lost) + " of " + all + " frames were lost; the model has the others only.");
  if (!report.map_doubt.empty()) return verdict("bad", "The map may be wrong: " + report.map_doubt);
  if (lost > 0)
    return verdict("fair",
                   std::to_string(lost) + " of " + all + " frames were lost; all others were tracked.");
  const size_t degenerate = countOf(frames, TrackingStatus::kDegenerate);
  if (10 * degenerate > frames.size())
    return verdict("fair", "No frame was lost, but in " + std::to_string(degenerate) + " of " + all +
                               " geometry left directions free.");
  return verdict("good", "All " + all + " frames were tracked, and none was lost.");
}

// Code stands between backticks.
std::string withCode(const std::string& text) {
  std::string result;
  bool is_code = false;
  for (const char c : escaped(text)) {
    if (c != '`') {
      result += c;
      continue;
    }
    result += is_code ? "</code>" : "<code>";
    is_code = !is_code;
  }
  return result;
}

std::string worstFrames(const RunReport& report) {
  const std::vector<RecordedFrame>& frames = report.record.frames();
  std::string figures;
  for (const WorstFrame& worst : report.record.worst()) {
    const RecordedFrame& frame = frames[worst.frame];
    std::string caption = "Frame " + std::to_string(worst.frame + 1) + ", " +
                          fixed(frame.stamp_s - frames.front().stamp_s, 1) + " s: " + nameOf(frame.status);
    if (!frame.reason.empty()) caption += ": " + frame.reason;
    if (frame.is_tracked && frame.status != TrackingStatus::kLost)
      caption += "; the map explains " + percentText(frame.explained, 1.0) + " of it";
    figures += "<figure><img alt=\"\" src=\"" + jpegAddress(worst.picture) + "\"><figcaption>" +
               escaped(caption) + "</figcaption></figure>\n";
  }
  if (figures.empty()) return "<p class=\"soft\">No frame went badly.</p>\n";
  return "<h3>The frames that went worst</h3>\n<div class=\"frames\">\n" + figures + "</div>\n";
}

std::string statisticsRow(const std::string& name, const ErrorStatistics& errors, double scale,
                          const std::string& unit) {
  std::string row = "<tr><td>" + name + "</td>";
  if (errors.count == 0) return row + "<td colspan=\"4\">none compared</td></tr>\n";
  for (const double value : {errors.rmse, errors.median, errors.percentile95, errors.max})
    row += "<td class=\"number\">" + fixed(scale * value, 2) + " " + unit + "</td>";
  return row + "</tr>\n";
}

}  // namespace

std::string headerSection(const RunReport& report) {
  const std::vector<RecordedFrame>& frames = report.record.frames();
  const auto frame_ms = report.stages_ms.find("frame");
  std::string facts =
      fact("frames tracked", std::to_string(frames.size() - countOf(frames, TrackingStatus::kLost)) + " of " +
                                 std::to_string(frames.size()));
  facts += fact("way of the sensor", fixed(wayLength_m(report.trajectory), 2) + " m");
  if (frame_ms != report.stages_ms.end())
    facts += fact("time a frame, median", fixed(percentile(frame_ms->second, 0.5), 1) + " ms");
  if (!report.mesh.triangles.empty()) facts += fact("triangles", grouped(report.mesh.triangles.size()));
  if (report.trajectory_error)
    facts += fact("trajectory error, RMSE", fixed(1000.0 * report.trajectory_error->ate_m.rmse, 1) + " mm");
  if (report.mesh_error)
    facts += fact("surface error, mean", fixed(1000.0 * report.mesh_error->surface_m.mean, 1) + " mm");
  if (report.loops > 0)
    facts += fact("loops closed", std::to_string(report.loops) + ", moving poses by up to " +
                                      fixed(1000.0 * report.moved_by_loops_m, 0) + " mm");
  return "<header>\n<h1>" + escaped(report.name) + "</h1>\n" + verdictOf(report) + "<dl class=\"facts\">\n" +
         facts + "</dl>\n</header>\n";
}

std::string trackingSection(const RunReport& report) {
  const std::vector<RecordedFrame>& frames = report.record.frames();
  if (frames.empty()) return "";
  std::vector<double> explained, map_mb;
  bool any_tracked = false;
  for (const RecordedFrame& frame : frames) {
    any_tracked = any_tracked || frame.is_tracked;
    const bool lost = frame.status == TrackingStatus::kLost;
    explained.push_back(lost ? 0.0 : frame.is_tracked ? 100.0 * frame.explained : 100.0);
    map_mb.push_back(frame.map_bytes / 1e6);
  }
  std::string key;
  for (const auto status : {TrackingStatus::kTracking, TrackingStatus::kDegenerate, TrackingStatus::kLost})
    key += std::string("<span style=\"--of:") + colorOf(status) + "\">" + nameOf(status) + ": " +
           std::to_string(countOf(frames, status)) + "</span>\n";
  const auto frame_ms = report.stages_ms.find("frame");
  std::string times;
  if (frame_ms != report.stages_ms.end())
    times = frameChart({"Time a frame", "ms", frame_ms->second, 1.5 * percentile(frame_ms->second, 0.95)});
  std::string losses;
  for (const LostFrames& loss : lossesOf(frames))
    losses += "<tr><td class=\"number\">" + std::to_string(loss.first + 1) + "</td><td class=\"number\">" +
              std::to_string(loss.count) + "</td><td>" + escaped(frames[loss.first].reason) + "</td></tr>\n";
  if (!losses.empty())
    losses =
        "<div class=\"scroll\"><table>\n<tr><th class=\"number\">lost from frame</th><th "
        "class=\"number\">frames</th>"
        "<th>why</th></tr>\n" +
        losses + "</table></div>\n";
  return "<section id=\"tracking\">\n<h2>Tracking</h2>\n<div class=\"key\">\n" + key + "</div>\n" +
         stateStrip(frames) +
         (any_tracked ? frameChart({"How much of a frame the map explains", "%", explained, 100.0, true})
                      : "") +
         times + frameChart({"The map's memory", "MB", map_mb}) + losses + worstFrames(report) +
         "</section>\n";
}

std::string adviceSection(const RunReport& report) {
  std::string items;
  for (const std::string& advice : adviceFor(report)) items += "<li>" + withCode(advice) + "</li>\n";
  if (items.empty()) items = "<li>Nothing of this run is poor.</li>\n";
  return "<section id=\"advice\">\n<h2>What to try</h2>\n<ul class=\"advice\">\n" + items +
         "</ul>\n</section>\n";
}

std::string errorSection(const RunReport& report) {
  if (!report.trajectory_error && !report.mesh_error) return "";
  std::string rows, figure;
  if (report.trajectory_error) {
    const TrajectoryError& error = *report.trajectory_error;
    rows += statisticsRow("trajectory (ATE), " + std::to_string(error.pairs.size()) + " poses", error.ate_m,
                          1000.0, "mm") +
            statisticsRow("shift over a second (RPE)", error.rpe_translation_m, 1000.0, "mm") +
            statisticsRow("turn over a second (RPE)", error.rpe_rotation_deg, 1.0, "deg");
  }
  if (report.mesh_error) rows += statisticsRow("surface", report.mesh_error->surface_m, 1000.0, "mm");
  if (!report.error_map.vertices.empty()) {
    figure = "<div class=\"pictures\">\n" +
             pictureFigure(rotated(levelFrom(report.error_map), report.error_map),
                           "The error of the surface: blue is none, red " +
                               fixed(1000.0 * report.error_full_scale_m, 0) + " mm and more") +
             "</div>\n";
  }
  return "<section id=\"errors\">\n<h2>Errors against the truth</h2>\n<div "
         "class=\"scroll\"><table>\n<tr><th></th>"
         "<th class=\"number\">RMSE</th><th class=\"number\">median</th><th class=\"number\">95 %</th>"
         "<th class=\"number\">max</th></tr>\n" +
         rows + "</table></div>\n" + figure + "</section>\n";
}

}  // namespace depth_fusion
