// What is shown, and in which colours.
#pragma once

#include <string>
#include <vector>

#include "depth_fusion/geometry/pose.h"
#include "depth_fusion/surface_mesh/triangle_mesh.h"

namespace depth_fusion {

struct ViewedModel {
  TriangleMesh mesh;               // without triangles: points
  std::vector<float> certainties;  // 0 to 1, one a vertex, or none
  Trajectory way;                  // of the sensor; may be empty
};

// Reads a folder of `reconstruct`, a mesh, points or a stored map. A map has certainties only if they are
// asked for, since that takes several times as long. Throws Error for what cannot be read.
ViewedModel readModel(const std::string& path, bool with_certainty, const std::string& device);

// Files that PCL reads: .stl, .pcd, and .ply that are not of triangles alone. Throws Error.
TriangleMesh readByPcl(const std::string& path);

// Lists "colors", "shaded" and "certainty".
const std::vector<std::string>& paintNames();

// The paints that the model has what is needed for; "shaded" always.
std::vector<std::string> paintsOf(const ViewedModel& model);

// One colour a vertex; certainty goes from blue to red.
std::vector<MeshColor> colorsOf(const ViewedModel& model, const std::string& paint);

}  // namespace depth_fusion
