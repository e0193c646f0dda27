#include "tools/report/run_report.h"

#include "tools/report/html.h"
#include "tools/report/level.h"
#include "tools/report/page_parts.h"
#include "tools/report/sections.h"

namespace depth_fusion {
namespace {

// The true poses in the world of the estimated ones.
Trajectory truthOf(const RunReport& report) {
  Trajectory truth;
  if (!report.trajectory_error) return truth;
  const Pose T_E_W = report.trajectory_error->T_W_E.inverse();
  for (const PosePair& pair : report.trajectory_error->pairs)
    truth.push_back({pair.stamp_s, T_E_W * pair.T_W_truth});
  return truth;
}

std::string modelSections(const RunReport& report) {
  if (report.mesh.vertices.empty()) return "";
  const Eigen::Matrix3d level = levelFrom(report.mesh);
  const TriangleMesh mesh = rotated(level, report.mesh);
  const Trajectory trajectory = rotated(level, report.trajectory);
  return pictureSection(mesh, trajectory) + modelSection(mesh, trajectory, report.viewer_command) +
         planSection(mesh, trajectory, rotated(level, truthOf(report)), report.record.frames());
}

}  // namespace

std::string pageOf(const RunReport& report) {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         escaped(report.name) + ": depth_fusion</title>\n<style>\n" + embeddedPagePart("page.css") +
         "</style>\n</head>\n<body>\n<main>\n" + headerSection(report) + modelSections(report) +
         trackingSection(report) + errorSection(report) + adviceSection(report) + costSection(report) +
         parameterSection(report) + "</main>\n<script>\n" + embeddedPagePart("model_viewer.js") +
         "</script>\n</body>\n</html>\n";
}

}  // namespace depth_fusion
