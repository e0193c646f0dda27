// A mesh with pictures on it.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "depth_fusion/geometry/camera_intrinsics.h"
#include "depth_fusion/geometry/pose.h"
#include "depth_fusion/surface_mesh/mesh_file.h"
#include "depth_fusion/surface_mesh/triangle_mesh.h"

namespace depth_fusion {

struct TexturedMesh {
  TriangleMesh mesh;  // a vertex that has several places in the texture is there several times
  std::vector<Eigen::Vector2f>
      places;                     // of each vertex in its page, pixels; (0, 0) is the middle of the first
  std::vector<size_t> page_ends;  // a page's triangles end before this one
  std::vector<cv::Mat> pages;     // CV_8UC3, BGR
};

// Throws Error unless the path ends in .obj, .glb or .ply, or the format is one of these, and the path lies
// in a folder that is there.
void checkTexturedPath(const std::string& path, const std::string& format = "");

// Writes MESH.glb, which holds all, or MESH.obj, with MESH.mtl, or MESH.ply, with MESH_0.png, MESH_1.png, ...
// beside them; an empty format is the path's ending. The mesh's own file comes last, and only if all of them
// could be written. Throws Error as checkTexturedPath() does, and if a file cannot be written.
void writeTexturedMesh(const std::string& path, const TexturedMesh& mesh, UpAxis up = UpAxis::kMinusY,
                       const std::string& format = "");

struct TexturedPicture {
  cv::Mat color;  // CV_8UC3, BGR, black where there is no surface
  cv::Mat depth;  // CV_32FC1, metres, 0 where there is none
};

// Draws the surface as the camera sees it, as bright as it is; what is seen from behind is left black.
TexturedPicture renderTexturedMesh(const TexturedMesh& mesh, const CameraIntrinsics& camera,
                                   const Pose& T_W_C);

}  // namespace depth_fusion
