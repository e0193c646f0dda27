// What is shown, and in which colours.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "depth_fusion/geometry/pose.h"
#include "depth_fusion/surface_mesh/mesh_file.h"
#include "depth_fusion/surface_mesh/triangle_mesh.h"

namespace depth_fusion {

struct ViewedModel {
  TriangleMesh mesh;               // without triangles: points
  std::vector<float> certainties;  // 0 to 1, one a vertex, or none
  std::vector<MeshColor> errors;   // of the vertices, as paintError() has them, or none
  Trajectory way;                  // of the sensor; may be empty

  // A texture, where there is one: pictures (CV_8UC3, BGR), whose triangles end before these, and where each
  // vertex lies in its picture, as shares of its size from the lower left corner on.
  std::vector<cv::Mat> pages;
  std::vector<size_t> page_ends;
  std::vector<Eigen::Vector2f> shares;
};

struct ModelSource {
  std::string path;             // a folder of `reconstruct`, a mesh, points or a stored map
  bool with_certainty = false;  // of a map: it takes several times as long
  std::string truth;            // a simulated recording, for the errors; empty: none
  float full_scale_m = 0.01f;   // the error that is red
  std::string device;
};

// Throws Error for what cannot be read.
ViewedModel readModel(const ModelSource& source);

// Files that assimp reads: .obj, .glb, .gltf, .dae, and .ply with a texture. Throws Error.
ViewedModel readByAssimp(const std::string& path);

// Files that PCL reads: .stl, .pcd, and .ply that are not of triangles alone. Throws Error.
TriangleMesh readByPcl(const std::string& path);

// Lists "texture", "colors", "shaded", "certainty" and "error".
const std::vector<std::string>& paintNames();

// The paints that the model has what is needed for; "shaded" always.
std::vector<std::string> paintsOf(const ViewedModel& model);

// One colour a vertex, whatever the texture; certainty and error go from blue to red.
std::vector<MeshColor> colorsOf(const ViewedModel& model, const std::string& paint);

}  // namespace depth_fusion
