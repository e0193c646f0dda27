// Pictures of meshes, drawn in software.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "depth_fusion/geometry/camera_intrinsics.h"
#include "depth_fusion/geometry/pose.h"
#include "depth_fusion/surface_mesh/triangle_mesh.h"

namespace depth_fusion {

enum class MeshPaint {
  kColors,  // the vertices' colours as they are, dark where seen from behind; a mesh without is shaded
  kShaded,  // bluish grey, lit from the camera, red where seen from behind
  kOpen,    // as kColors, but what is seen from behind is left out: one looks into a room from outside
};

// Draws the triangles in front of the camera, as CV_8UC3, BGR. Triangles that reach behind the camera are
// left out.
cv::Mat renderMesh(const TriangleMesh& mesh, const CameraIntrinsics& camera, const Pose& T_W_C,
                   MeshPaint paint = MeshPaint::kColors);

// Makes a camera of the given size and field of view with its principal point in the middle.
CameraIntrinsics pictureCamera(int width, int height, double horizontal_view_rad);

// Lists the names that viewOf() knows, the default first.
const std::vector<std::string>& viewNames();

// Returns a pose from which the camera sees the mesh, but for one vertex in a hundred. The mesh is taken to
// be in the frame of its first camera (x right, y down, z forward): "auto" looks forward and down from
// behind, the others look along an axis. Throws Error for another name, and for a mesh without vertices.
Pose viewOf(const TriangleMesh& mesh, const CameraIntrinsics& camera, const std::string& name);

}  // namespace depth_fusion
