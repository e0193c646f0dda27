// Pictures of a model, and its plan.
#pragma once

#include <string>

#include "tools/report/run_report.h"

namespace depth_fusion {

// The mesh from up to four sides above, those that show much of it, where what is seen from behind is left
// out, and as the sensor saw it, as figures of HTML. Mesh and trajectory are level.
std::string pictureFigures(const TriangleMesh& mesh, const Trajectory& trajectory);

// The same of one view from above.
std::string pictureFigure(const TriangleMesh& mesh, const std::string& caption);

// The sensor's way over the mesh from above, as SVG: coloured by state, over the true one if that is given.
std::string planOf(const TriangleMesh& mesh, const Trajectory& trajectory, const Trajectory& truth,
                   const std::vector<RecordedFrame>& frames);

}  // namespace depth_fusion
