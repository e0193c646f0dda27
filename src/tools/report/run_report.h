// A run as a page that a person wants to look at.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "depth_fusion/surface_mesh/triangle_mesh.h"
#include "tools/evaluation/mesh_error.h"
#include "tools/evaluation/trajectory_error.h"
#include "tools/report/run_record.h"

namespace depth_fusion {

struct ReportParameter {
  std::string name, value, usual_value, help;
};

struct RunReport {
  std::string name;  // of the recording
  std::string input, device;
  std::string viewer_command;  // empty: there is nothing to view
  RunRecord record;
  Trajectory trajectory;  // of the tracked frames, in the mesh's world
  TriangleMesh mesh;      // without vertices: there is none
  std::string map_doubt;  // TrackingResult::map_doubt, if there was one
  size_t unreadable = 0, colored = 0;
  bool wants_color = false;
  size_t loops = 0;                                      // closed
  double moved_by_loops_m = 0.0;                         // the pose that they moved most
  std::map<std::string, std::vector<double>> stages_ms;  // the times of every stage, "frame" among them
  size_t pool_blocks = 0, pool_capacity = 0;
  double map_bytes = 0.0, pool_bytes = 0.0, peak_rss_bytes = 0.0;
  std::optional<TrajectoryError> trajectory_error;
  std::optional<MeshError> mesh_error;
  TriangleMesh error_map;            // the mesh in the colours of its error; without vertices: there is none
  double error_full_scale_m = 0.01;  // that is red in the error map
  std::vector<ReportParameter> parameters;
};

// One HTML file, which needs no other and no network. Pictures are drawn for it, which takes seconds.
std::string pageOf(const RunReport& report);

}  // namespace depth_fusion
