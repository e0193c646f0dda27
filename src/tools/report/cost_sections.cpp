// What a report says of time, memory and parameters.
#include <algorithm>

#include "depth_fusion/common/percentile.h"
#include "tools/report/html.h"
#include "tools/report/sections.h"

namespace depth_fusion {
namespace {

std::string row(const std::string& name, const std::string& value) {
  return "<tr><td>" + escaped(name) + "</td><td class=\"number\">" + escaped(value) + "</td></tr>\n";
}

// Stages are named as paths; those within others stand behind them, further in.
std::string stageRows(const RunReport& report) {
  const auto frame = report.stages_ms.find("frame");
  const double frame_ms = frame == report.stages_ms.end() ? 1.0 : percentile(frame->second, 0.5);
  std::string rows;
  for (const auto& [stage, samples_ms] : report.stages_ms) {
    const double median_ms = percentile(samples_ms, 0.5);
    rows += "<tr><td>" + escaped(stage) + "</td><td class=\"number\">" + fixed(median_ms, 2) +
            "</td><td class=\"number\">" + fixed(percentile(samples_ms, 0.95), 2) +
            "</td><td class=\"number\">" + std::to_string(samples_ms.size()) +
            "</td><td class=\"bar\"><div style=\"width:" +
            fixed(std::min(100.0 * median_ms / frame_ms, 100.0), 1) + "%\"></div></td></tr>\n";
  }
  return rows;
}

std::string parameterRows(const RunReport& report, bool changed) {
  std::string rows;
  for (const ReportParameter& parameter : report.parameters) {
    if ((parameter.value != parameter.usual_value) != changed) continue;
    const std::string usual =
        changed ? " <span class=\"soft\">(usually " + escaped(parameter.usual_value) + ")</span>" : "";
    rows += "<tr><td><code>" + escaped(parameter.name) + "</code></td><td>" + escaped(parameter.value) +
            usual + "</td><td class=\"soft help\">" + escaped(parameter.help) + "</td></tr>\n";
  }
  return rows;
}

std::string table(const std::string& rows) {
  return "<div class=\"scroll\"><table>\n" + rows + "</table></div>\n";
}

}  // namespace

std::string costSection(const RunReport& report) {
  const std::string head =
      "<tr><th>stage</th><th class=\"number\">median ms</th><th class=\"number\">95 %</th>"
      "<th class=\"number\">times</th><th></th></tr>\n";
  const std::string memory =
      row("the map", bytesText(report.map_bytes)) +
      row("the pool that holds it", bytesText(report.pool_bytes)) +
      row("the pool's blocks in use", grouped(report.pool_blocks) + " of " + grouped(report.pool_capacity)) +
      row("the process, at most", bytesText(report.peak_rss_bytes));
  return "<section id=\"times\">\n<h2>Times</h2>\n<p class=\"soft\">" + escaped(report.device) + "</p>\n" +
         table(head + stageRows(report)) + "</section>\n<section id=\"memory\">\n<h2>Memory</h2>\n" +
         table(memory) + "</section>\n";
}

std::string parameterSection(const RunReport& report) {
  const std::string changed = parameterRows(report, true), usual = parameterRows(report, false);
  return "<section id=\"parameters\">\n<h2>Input and parameters</h2>\n<p>" + escaped(report.input) +
         "</p>\n" +
         (changed.empty() ? "<p class=\"soft\">All parameters have their usual values.</p>\n"
                          : table(changed)) +
         "<details><summary>Parameters with their usual values</summary>\n" + table(usual) +
         "</details>\n</section>\n";
}

}  // namespace depth_fusion
