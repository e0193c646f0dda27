// The service export_mesh: the map's surface to a file, beside mapping.
#pragma once

#include <depth_fusion/ExportMesh.h>

#include "depth_fusion/texturing/texturing_parameters.h"
#include "ros/in_process/shared_map.h"

namespace depth_fusion {

// The path itself if it is absolute, else below ROS_HOME (~/.ros without that variable). ~ and environment
// variables are expanded. Throws Error for one that is not set.
std::string absolutePath(const std::string& path);

struct MeshExportParameters {
  SurfaceMeshParameters mesh;
  TexturingParameters texturing;
};

// Writes the surface of the map as it is now. The map is locked for a snapshot only. Throws Error for a
// request that cannot be met, and if the file cannot be written; then no file is left.
ExportMesh::Response exportMesh(SharedMap& map, const ExportMesh::Request& request,
                                const MeshExportParameters& parameters);

}  // namespace depth_fusion
