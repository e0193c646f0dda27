// Exports: the map's surface to a file or into a message, beside mapping.
#pragma once

#include <depth_fusion/ExportMesh.h>
#include <depth_fusion/MeshGeometry.h>

#include <functional>
#include <string>

#include "ros/in_process/shared_map.h"

namespace depth_fusion {

// The path itself if it is absolute, else below ROS_HOME (~/.ros without that variable). ~ and environment
// variables are expanded. Throws Error for one that is not set.
std::string absolutePath(const std::string& path);

// Is called with the share of the surface that is extracted, from 0 to 1, and throws to give up.
using ExportProgress = std::function<void(double done)>;

// Writes the surface of the map as it is now. The map is locked for a snapshot only. Throws Error for a
// request that cannot be met, and if the file cannot be written; then no file is left.
ExportMesh::Response exportMesh(SharedMap& map, const ExportMesh::Request& request,
                                const SurfaceMeshParameters& parameters,
                                const ExportProgress& progress = nullptr);

// The same into a message: the request's path and format say nothing, and the response's message is empty but
// for a remark. Throws Error for a mesh that no message can have, too.
ExportMesh::Response exportMesh(SharedMap& map, const ExportMesh::Request& request,
                                const SurfaceMeshParameters& parameters, const ExportProgress& progress,
                                MeshGeometry& mesh);

}  // namespace depth_fusion
