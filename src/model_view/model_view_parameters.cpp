#include "depth_fusion/model_view/model_view_parameters.h"

namespace depth_fusion {

const Enumeration<Renderer>& renderers() {
  static const Enumeration<Renderer> all = {{"ray_casting", Renderer::kRayCasting},
                                            {"marching_cubes", Renderer::kMarchingCubes}};
  return all;
}

ParameterTable ModelViewParameters::table() {
  return atStartOnly(
      {choice("renderer", &renderer, renderers(),
              "how the map is rendered: rays cast through it, or its triangles rasterised"),
       flag("half_size", &half_size,
            "true: views, and pictures of them, have half the depth image's width and height, for a machine "
            "that is short of time; what is narrower than four pixels of it may be missing from them")});
}

}  // namespace depth_fusion
