// The sections of a report's page, as HTML. Those that have nothing to say are empty.
#pragma once

#include <string>

#include "tools/report/run_report.h"

namespace depth_fusion {

std::string headerSection(const RunReport& report);
std::string trackingSection(const RunReport& report);
std::string adviceSection(const RunReport& report);
std::string errorSection(const RunReport& report);
std::string costSection(const RunReport& report);
std::string parameterSection(const RunReport& report);
// Of models that are level.
std::string pictureSection(const TriangleMesh& mesh, const Trajectory& trajectory);
std::string modelSection(const TriangleMesh& mesh, const Trajectory& trajectory,
                         const std::string& viewer_command);
std::string planSection(const TriangleMesh& mesh, const Trajectory& trajectory, const Trajectory& truth,
                        const std::vector<RecordedFrame>& frames);

}  // namespace depth_fusion
