#include "depth_fusion/texturing/texturing_parameters.h"

namespace depth_fusion {

ParameterTable TexturingParameters::table() {
  return {
      number("max_views", &max_views, 1, 65535, "pictures that the texture is made of, at most"),
      number("view_distance_m", &view_distance_m, 0.001, 100.0,
             "a picture is left out if a sharper one was taken nearer than this, and"),
      number("view_angle_rad", &view_angle_rad, 0.001, 3.2, "turned by less than this"),
      number(
          "alignment_rounds", &alignment_rounds, 0, 100,
          "in which poses and exposures of the pictures are fitted to the colours that all of them have of "
          "the surface; 0: they are as they came"),
      number("alignment_points", &alignment_points, 100, 1000000, "of the surface that are compared for it"),
      number("max_incidence_rad", &max_incidence_rad, 0.1, 1.57,
             "between a face's normal and the ray to the camera; beyond, a picture shows too little of it"),
      number("hidden_ratio", &hidden_ratio, 0.001, 1.0,
             "of the depth by which a face lies behind what hides it"),
      number("outlier_levels", &outlier_levels, 1.0, 255.0,
             "by which a picture's colour of a face, 0 to 255, differs from most pictures' if it shows "
             "something else; three sigmas of the others at least"),
      number("smoothness", &smoothness, 0.0, 100.0,
             "cost of a seam at an edge; a face's best picture costs nothing, a useless one 1"),
      number("seam_stiffness", &seam_stiffness, 0.001, 100.0,
             "how little the colour that levels seams changes along a picture's part"),
      number("page_px", &page_px, 256, 16384, "width and height of a page of the texture, at most")};
}

}  // namespace depth_fusion
