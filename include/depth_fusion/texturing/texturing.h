// Texturing: pictures of a surface that was fused become its texture.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "depth_fusion/texturing/textured_mesh.h"
#include "depth_fusion/texturing/texturing_parameters.h"

namespace depth_fusion {

// A picture of the surface, and where it was taken.
struct TexturingView {
  std::string image;        // as a JPEG or PNG file has it
  CameraIntrinsics camera;  // of the image, without distortion
  Pose T_W_C = Pose::Identity();
};

// What was made of what.
struct TexturingReport {
  size_t views = 0, chosen = 0;  // pictures that were given, and used
  size_t faces = 0, seen = 0;    // seen by a picture; the others have the vertices' colours
  double seen_area = 0.0;        // share of the surface's area
  size_t outliers = 0;           // pictures of faces that show something else
  size_t patches = 0;            // of one picture each
  double misfit_before = 0.0,
         misfit_after = 0.0;                    // mean difference of pictures from their mean, of 255 levels
  double move_m = 0.0;                          // of the cameras, median
  double seam_step = 0.0, seam_gradient = 0.0;  // across patches' borders, and within patches along them
  double fill = 0.0;                            // share of the pages' pixels that faces have
};

struct Texturing {
  TexturedMesh textured;
  TexturingReport report;
};

// Textures the mesh with what the views show of it. Where none shows a face it has its vertices' colours, or
// grey if there are none. Each face has one picture, the one that shows it best among those that agree on it,
// and neighbours like to share it; where they do not, colours are levelled and blended. `progress` is called
// with what is done and the share of it that is done, and throws to give up. Throws Error for a mesh without
// faces, without a view, and for a view whose image cannot be decoded or has not its camera's size. The
// method is that of M. Waechter, N. Moehrle and M. Goesele, "Let There Be Color!" (2014), on poses refined as
// by Q.-Y. Zhou and V. Koltun, "Color Map Optimization" (2014).
Texturing textureMesh(const TriangleMesh& mesh, std::vector<TexturingView> views,
                      const TexturingParameters& parameters,
                      const std::function<void(const std::string& step, double done)>& progress = nullptr);

}  // namespace depth_fusion
