#include "depth_fusion/model_view/model_view_parameters.h"

namespace depth_fusion {

ParameterTable ModelViewParameters::table() {
  return atStartOnly(
      {{"renderer",
        &renderer,
        0.0,
        0.0,
        "how the map is rendered: rays cast through it, or its triangles rasterised",
        {"ray_casting", "marching_cubes"}},
       {"half_size", &half_size, 0, 1,
        "true: views, and pictures of them, have half the depth image's width and height, for a machine "
        "that is short of time; what is narrower than four pixels of it may be missing from them"}});
}

}  // namespace depth_fusion
