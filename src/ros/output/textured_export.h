// The service export_mesh, with pictures on the surface.
#pragma once

#include <functional>
#include <string>

#include "depth_fusion/relocalisation/keyframe.h"
#include "depth_fusion/surface_mesh/triangle_mesh.h"
#include "depth_fusion/texturing/texturing_parameters.h"

namespace depth_fusion {

struct TexturedExport {
  MeshSize size;
  std::string remark;  // what there is to say of it
};

// Writes the mesh, with z up, and the keyframes' pictures on it. Throws Error if no keyframe has one, if the
// files cannot be written, when ROS shuts down, and what go_on throws, which is called again and again.
TexturedExport exportTextured(const std::string& path, const std::string& format, const TriangleMesh& mesh,
                              const Keyframes& keyframes, const TexturingParameters& parameters,
                              const std::function<void()>& go_on);

}  // namespace depth_fusion
