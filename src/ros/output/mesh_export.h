// The service export_mesh: the map's surface to a file, beside mapping.
#pragma once

#include <depth_fusion/ExportMesh.h>
#include <depth_fusion/MeshGeometry.h>

#include <functional>
#include <string>

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

// Is called with the share of the surface that is extracted, from 0 to 1, and throws to give up.
using ExportProgress = std::function<void(double done)>;

// Writes the surface of the map as it is now, to the request's path or, if it is not null, to the message:
// then path and format say nothing. The map is locked for a snapshot only. Throws Error for a request that
// cannot be met, if the file cannot be written, and for a mesh that no message can have; then no file is
// left.
ExportMesh::Response exportMesh(SharedMap& map, const ExportMesh::Request& request,
                                const MeshExportParameters& parameters,
                                const ExportProgress& progress = nullptr, MeshGeometry* message = nullptr);

}  // namespace depth_fusion
